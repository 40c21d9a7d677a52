// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "record/record.h"

namespace ispace {

/// Checks that bytes are text: UTF-8 without control characters other than tab, LF and CR LF.
/// \throws FormatError with one finding, at the first byte that is not. O(bytes)
void checkTextBytes(std::string_view bytes, const std::string& name);

/// The bytes without the UTF-8 byte order mark that some editors write at their start.
std::string_view withoutBom(std::string_view bytes);

/// Takes lines off the front of a text, their ends (LF or CR LF) removed.
class LineReader {
  public:
    explicit LineReader(std::string_view text) : rest_(text) {}
    /// The next line, or nothing at the end; a last line needs no end.
    std::optional<std::string_view> next();
    /// Number of the line last given, from 1.
    [[nodiscard]] int number() const { return number_; }

  private:
    std::string_view rest_;
    int number_ = 0;
};

/// A piece of a line, with its column in bytes from 1.
struct Piece {
    std::string_view text;
    int column = 0;
};

/// An error in the grammar of a line.
struct LexError {
    std::string message;
    int column = 0;
};

/// One `key=value`.
struct Field {
    Piece key;
    Piece value;  ///< without quotes and escapes; valid until the next call
};

/// Splits one line of the record language; see readRecordText for the grammar.
///
/// After an error the lexer continues behind the faulty piece, so that the rest is read as well.
class LineLexer {
  public:
    explicit LineLexer(std::string_view line) : line_(line) {}

    /// The first word, or nothing if the line is blank or a comment.
    std::optional<Piece> keyword();
    /// True if there is more to read with field().
    bool more();
    /// \throws LexError
    Field field();
    /// A value without a key, as lists of names have them; see Field::value.
    /// \pre more() \throws LexError
    Piece word();

  private:
    void skipBlanks();
    void skipPiece();
    [[nodiscard]] bool atEnd() const { return next_ >= line_.size(); }
    [[nodiscard]] int column() const { return static_cast<int>(next_) + 1; }
    Piece plainValue(int column);
    Piece quotedValue(int column);

    std::string_view line_;
    std::size_t next_ = 0;
    std::string unescaped_;
};

/// True if the bytes begin with `#env` or `#3dm`, the magic words of the text formats.
bool isRecordText(std::string_view bytes);

/// Reads `.env` and `.3dm` text. `name` is used in messages as it is.
///
/// Grammar, a line each: blank, `# comment`, or `keyword key=value …` with blanks between and
/// none around `=`. A value is a run of characters other than blanks, `"` and `#`, or a "string"
/// with the escapes \" \\ \n \t. `#` begins a comment after a blank or at the start of a line.
/// Lines end with LF or CRLF. A key may appear once. History is the run of `# ` lines directly
/// after the magic line; later magic lines (cat of two files) are comments. A byte order mark at
/// the start is passed over. O(bytes), also for files full of errors.
/// \throws FormatError with all findings: unknown keywords and keys with a suggestion, bad
///         values, missing keys, doubled ids, bytes that are no UTF-8 or control
///         characters (one finding at the first of them), another version, an empty file
Document readRecordText(std::string_view bytes, const std::string& name, const Schemas& schemas);

/// Magic line, history lines, one record a line in canonical form (written values only, those
/// equal to the default left out, keys in schema order).
std::string writeRecordText(const Document& document);

/// One record in canonical form, without newline.
std::string formatRecord(const Record& record);
/// Appends formatRecord(record).
void appendRecord(std::string& out, const Record& record);

/// Reads one record from the text of a line, for options such as `--add`; `name` is the place.
Record readRecord(std::string_view line, const std::string& name, const Schemas& schemas);

/// Checks that no written id is doubled; findings name both lines.
/// \throws FormatError
void checkIds(const std::vector<Record>& records);

/// "sha256:" and 64 hex digits of the bytes.
std::string sha256(std::string_view bytes);

/// sha256 over the vertices, then the triangles, as little-endian 32-bit numbers.
std::string meshDigest(const TriangleMesh& mesh);

/// Digest of an environment: sha256 over the canonical lines (each with its newline) of the
/// environment records, in file order; placements, results and history do not count. A file that is
/// loaded counts by its content: its name gives way to `digest`.
std::string environmentDigest(std::span<const Record> records);
std::string environmentDigest(std::span<const Record* const> records);

}  // namespace ispace
