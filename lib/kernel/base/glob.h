// SPDX-License-Identifier: GPL-3.0-or-later
// Patterns of names as shells have them, matched without a look at any file.
//
// Patterns are untrusted: a match takes at most (name bytes) * (1 + pattern bytes / 64) word
// operations, however many stars there are, as bits of words are the states of an automaton (R.
// Baeza-Yates, G. Gonnet, A new approach to text searching, 1992; S. Wu, U. Manber, Fast text
// searching allowing errors, 1992).
//
//     const bool is_hall = Glob("hall-[0-9]*").matches("hall-2-east");  // true
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// A shell pattern of names: `*` matches any bytes, `?` one, `[a-z]` and `[!a-z]` one of a set
/// (with `[:alpha:]` and other classes), `\` the next byte literally. A name also matches a pattern
/// with the same text, and an unclosed bracket matches itself. Case counts.
///
/// Bytes, not characters: `?` matches one byte of UTF-8. A pattern with special bytes takes 256
/// words for each 64 of its bytes. Thread-safe once built.
class Glob {
  public:
    Glob() = default;  ///< matches the empty name
    explicit Glob(std::string_view text);

    /// The pattern as written.
    [[nodiscard]] const std::string& text() const { return text_; }
    /// False if the pattern matches only its own text.
    [[nodiscard]] bool isPattern() const { return !accepts_.empty(); }
    [[nodiscard]] bool matches(std::string_view name) const;

  private:
    std::string text_;
    // The states of an automaton: bit j is set once the first j elements have been matched.
    // `accepts_` holds words_ words for each byte: bit j if the byte matches element j. `loops_`
    // has bit j if a star follows the first j elements.
    std::size_t words_ = 0, elements_ = 0;
    std::vector<std::uint64_t> accepts_, loops_;
};

}  // namespace ispace
