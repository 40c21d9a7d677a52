// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <vector>

namespace ispace {

/// Weights in whole units, as a Problem has them, with a sum below 2^32: times the least power of
/// ten that makes all of them whole, to within a billionth of the largest weight (or of 1, if that
/// is larger: decimals are as written, not as stored). Where none does, times as large a power as
/// the sum allows, up to six decimals and six digits of the largest weight; where the sum is too
/// large as it is, all are made smaller in proportion. Rounded then, but what is above 0 is at
/// least one unit. O(n) for each power tried
/// \pre none is below 0, all are finite, and there are at most 2^28
std::vector<std::uint32_t> wholeUnits(const std::vector<double>& worth);

}  // namespace ispace
