// SPDX-License-Identifier: GPL-3.0-or-later
// Compares a text with the expected one, as golden-diff(1) does: words and blanks must agree byte
// by byte, numbers within a tolerance. Pure functions, O(bytes).
//
//     const std::string found = textDifference(withoutHistory(wanted), withoutHistory(text), {});
//     if (!found.empty()) fail(found);  // names the line
#pragma once

#include <string>
#include <string_view>

namespace ispace {

/// Tolerance of two numbers: |a - b| <= absolute + relative * max(|a|, |b|).
struct Tolerance {
    double absolute = 1e-9;
    double relative = 1e-9;
};

/// Removes the history, which differs between runs: the run of `# ` lines after a magic line, and
/// the value of `"history"` in JSON.
std::string withoutHistory(std::string_view text);

/// Returns "" if the texts agree, else a printable description of the first difference with its
/// line number.
///
/// Words that parse entirely as numbers (`-1.5`, `3e-4`; not `5cm` or `a1`) are compared within the
/// tolerance, all other text byte by byte, blanks included. A full stop that ends a word is text.
/// Stops at the first difference: O(bytes).
///
///     textDifference("range 1.0000001 m", "range 1 m", {1e-6, 0});  // "": they agree
std::string textDifference(std::string_view expected, std::string_view actual, Tolerance tolerance);

}  // namespace ispace
