// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/golden.h"

namespace ispace {

/// The differences of two JSON texts, or of two texts of JSON lines, each as
/// `coverage.exact: 0.9168 → 0.8582 (±1e-6)`: the path of keys and indices, both values, and for
/// numbers the tolerance. Numbers agree within the tolerance; the order of keys and blanks between
/// them do not count. Empty if the texts agree, nothing if either is not JSON.
/// \param ignored globs: keys (`digest`) at any depth, or whole paths (`sensors.*.model`)
std::optional<std::vector<std::string>> jsonDifferences(std::string_view expected,
                                                        std::string_view actual,
                                                        Tolerance tolerance,
                                                        std::span<const std::string> ignored);

}  // namespace ispace
