// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace ispace {

/// How far two numbers may lie apart: |a - b| <= absolute + relative * max(|a|, |b|).
struct Tolerance {
    double absolute = 1e-9;
    double relative = 1e-9;
};

/// The text without its history: the run of `# ` lines after a magic line, and the value of
/// `"history"` in JSON. How a file came about is not what it says.
std::string withoutHistory(std::string_view text);

/// "" if the texts agree, else a description of the first difference with its line number, made
/// printable.
///
/// Words that are numbers as a whole (`-1.5`, `3e-4`; not `5cm` or `a1`) are compared within the
/// tolerance, everything else byte by byte, blanks included.
std::string textDifference(std::string_view expected, std::string_view actual, Tolerance tolerance);

}  // namespace ispace
