// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"

namespace ispace {

/// Checks that bytes are text: UTF-8 without control characters other than tab, LF and CR LF.
/// \throws FormatError with one finding, at the first byte that is not. O(bytes)
void checkTextBytes(std::string_view bytes, const std::string& name);

/// The bytes without the UTF-8 byte order mark that some editors write at their start.
std::string_view withoutMark(std::string_view bytes);

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

/// What the line's grammar does not allow.
struct LexError {
    std::string message;
    int column = 0;
};

/// One `key=value`.
struct Field {
    Piece key;
    Piece value;  ///< without quotes and escapes; valid until the next call
};

/// Takes one line of the record language apart (grammar: readRecordText).
///
/// After an error the lexer stands behind what was wrong, so that the rest is read as well.
class LineLexer {
  public:
    explicit LineLexer(std::string_view line) : line_(line) {}

    /// The first word, or nothing if the line is blank or a comment.
    std::optional<Piece> keyword();
    /// True if there is more to read with field().
    bool more();
    /// \throws LexError
    Field field();

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

}  // namespace ispace
