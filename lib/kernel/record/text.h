// SPDX-License-Identifier: GPL-3.0-or-later
// The text of .env and .3dm, and digests. Reading and writing are inverse: the canonical text of a
// document reads back as equal records, and is the same on every machine, so digests identify
// rooms.
//
//     const Document room = readRecordText(readAll("room.env"), "room.env", schemas);
//     const std::string canonical = writeRecordText(room);
//     const std::string digest = environmentDigest(room.records);  // sha256:...
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "record/record.h"

namespace ispace {

/// Validates that bytes are text: UTF-8 without control characters other than tab, LF and CR LF.
/// \throws FormatError with one finding, at the first invalid byte. O(bytes)
void checkTextBytes(std::string_view bytes, const std::string& name);

/// Removes the UTF-8 byte order mark that some editors write at the start.
std::string_view withoutBom(std::string_view bytes);

/// Splits a text into lines and removes line endings (LF or CR LF).
class LineReader {
  public:
    explicit LineReader(std::string_view text) : rest_(text) {}
    /// Returns the next line, empty at the end of the text; the last line needs no line ending.
    std::optional<std::string_view> next();
    /// Number of the line returned last, from 1.
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
/// After an error the lexer skips the faulty piece and continues, so that further errors are found.
class LineLexer {
  public:
    explicit LineLexer(std::string_view line) : line_(line) {}

    /// Reads the first word; empty if the line is blank or a comment.
    std::optional<Piece> keyword();
    /// Returns true if field() has more to read.
    bool more();
    /// \throws LexError
    Field field();
    /// Reads a value without a key, as in lists of names; see Field::value.
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

/// Returns true if the bytes begin with `#env` or `#3dm`, the magic words of the text formats.
bool isRecordText(std::string_view bytes);

/// Reads `.env` and `.3dm` text. Messages quote `name` unchanged.
///
/// Each line is blank, `# comment`, or `keyword key=value …`, separated by blanks, without blanks
/// around `=`. A value is a run of characters other than blanks, `"` and `#`, or a "string" with
/// the escapes \" \\ \n \t. `#` begins a comment after a blank or at the start of a line. Lines end
/// with LF or CRLF. A key may appear once. The `# ` lines directly after the magic line are the
/// history; later magic lines (cat of two files) are comments. A byte order mark at the start is
/// skipped. O(bytes), also for files full of errors.
/// \throws FormatError with all findings: unknown keywords and keys with a suggestion, bad values,
///         missing keys, doubled ids, invalid UTF-8 or control characters (one finding, at the
///         first of them), another version, an empty file
Document readRecordText(std::string_view bytes, const std::string& name, const Schemas& schemas);

/// Writes the magic line, history lines, and one record a line in canonical form: keys in schema
/// order, without values equal to the default.
std::string writeRecordText(const Document& document);

/// Writes one record in canonical form, without newline.
std::string formatRecord(const Record& record);
/// Appends formatRecord(record).
void appendRecord(std::string& out, const Record& record);

/// Reads one record from a line of text, for options such as `--add`; `name` stands for the file.
Record readRecord(std::string_view line, const std::string& name, const Schemas& schemas);

/// Checks that written ids are unique.
/// \throws FormatError; its findings name both lines
void checkIds(const std::vector<Record>& records);

/// Computes "sha256:" and 64 hex digits over the bytes (FIPS 180-4).
std::string sha256(std::string_view bytes);

/// Computes the sha256 over the vertices, then the triangles, as little-endian 32-bit numbers.
std::string meshDigest(const TriangleMesh& mesh);

/// Computes the digest of an environment: sha256 over the canonical lines (each with its newline)
/// of the environment records, in file order, without placements, results and history. For a
/// loaded file, `digest` replaces the file name.
std::string environmentDigest(std::span<const Record> records);
std::string environmentDigest(std::span<const Record* const> records);

}  // namespace ispace
