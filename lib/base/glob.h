// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// A pattern of names as shells have them: `*` any bytes, `?` one, `[a-z]` and `[!a-z]` one of a
/// set (with `[:alpha:]` and its kin), `\` before a byte that stands for itself. A name also
/// matches the pattern that spells it, and a bracket that is never closed stands for itself. Case
/// is ignored for ASCII letters only.
///
/// Patterns come from strangers: a match takes at most (name bytes) * (1 + pattern bytes / 64) word
/// operations, however many stars there are.
class Glob {
  public:
    Glob() = default;  ///< matches the empty name
    explicit Glob(std::string_view text);

    /// As written.
    [[nodiscard]] const std::string& text() const { return text_; }
    /// False if it matches one name alone, its text.
    [[nodiscard]] bool isPattern() const { return !accepts_.empty(); }
    [[nodiscard]] bool matches(std::string_view name) const;

  private:
    std::string text_;
    // The states of an automaton: bit j is set once the first j elements have been matched.
    // `accepts_` has words_ words for each byte: bit j if that may be element j. `loops_` has bit j
    // if a star stands behind the first j elements.
    std::size_t words_ = 0, elements_ = 0;
    std::vector<std::uint64_t> accepts_, loops_;
};

}  // namespace ispace
