// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only.
#pragma once

#include <cstdint>
#include <vector>

namespace ispace {

/// Weights in whole units, as a Problem has them: times the least power of ten that makes all of
/// them whole, or as large a one as their sum below 2^32 allows. \pre none is below 0
/// \throws UsageError for weights whose sum is too large as it is
std::vector<std::uint32_t> wholeUnits(const std::vector<double>& worth);

}  // namespace ispace
