// SPDX-License-Identifier: GPL-3.0-or-later
// tests/golden: runs a case and compares its output with the expected one, by the comparison of
// golden-diff, base/golden.h.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace golden {

/// Returns the CMake source with `ERR "line"` as the end of the row `ispace_golden(name …)`;
/// without any ERR for an empty line. Returns no value without such a row.
std::optional<std::string> withErrorLine(std::string_view source, std::string_view name,
                                         std::string_view line);

}  // namespace golden
