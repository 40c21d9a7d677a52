// SPDX-License-Identifier: GPL-3.0-or-later
// Divides sensors among parts of a site that are searched alone (search_parts.h), with a bound for
// the whole.
#pragma once

#include <span>
#include <vector>

namespace ispace {

/// Value of the best layout found, and an upper bound on it, of 0, 1, 2 ... sensors in a part of a
/// site. More sensors than it has entries have the last one. Neither is empty.
struct GainCurve {
    std::vector<double> values, bounds;
};

/// Numbers of sensors in the parts.
struct SharedOut {
    std::vector<int> counts;  ///< by part
    double value = 0;         ///< sum of the parts' values: the greatest of all splits
    double bound = 0;         ///< greatest sum of the parts' bounds of all splits
};

/// Shares a number of sensors out over parts. Values and bounds of curves add up, as no sensor of
/// one part sees floor of another; so the bound holds for every layout of that many sensors. Of
/// equally good splits, earlier parts have more sensors. Dynamic programming over parts, exact:
/// O(parts * sensors^2)
///
///     const std::vector<GainCurve> storeys{{{0, 5, 6}, {0, 5, 6}}, {{0, 4, 7}, {0, 4, 7}}};
///     const SharedOut shared = shareOut(storeys, 3);  // counts {1, 2}, value 12
///
/// \pre sensors >= 0
SharedOut shareOut(std::span<const GainCurve> curves, int sensors);

}  // namespace ispace
