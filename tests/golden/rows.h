// SPDX-License-Identifier: GPL-3.0-or-later
// tests/golden: runs a case and holds what it writes to what is expected of it. The comparison
// itself is that of golden-diff, base/golden.h.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace golden {

/// The CMake source with `ERR "line"` as the end of the row `ispace_golden(name …)`; without any
/// ERR for an empty line. Nothing if there is no such row.
std::optional<std::string> withErrorLine(std::string_view source, std::string_view name,
                                         std::string_view line);

}  // namespace golden
