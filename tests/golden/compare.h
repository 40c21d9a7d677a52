// SPDX-License-Identifier: GPL-3.0-or-later
// tests/golden: compares what a tool writes with what it should write. Standard library only.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace golden {

/// How far two numbers may lie apart: |a - b| <= absolute + relative * max(|a|, |b|).
struct Tolerance {
    double absolute = 1e-9;
    double relative = 1e-9;
};

/// The text without its history: the run of `# ` lines after a magic line, and the value of
/// `"history"` in JSON. How a file came about is not what a case is about.
std::string withoutHistory(std::string_view text);

/// "" if the texts agree, else a description of the first difference with its line number.
///
/// Words that are numbers as a whole (`-1.5`, `3e-4`; not `5cm` or `a1`) are compared within the
/// tolerance, everything else byte by byte, blanks included.
std::string difference(std::string_view expected, std::string_view actual, Tolerance tolerance);

/// The CMake source with `ERR "line"` as the end of the row `ispace_golden(name …)`; without any
/// ERR for an empty line. Nothing if there is no such row.
std::optional<std::string> withErrorLine(std::string_view source, std::string_view name,
                                         std::string_view line);

}  // namespace golden
