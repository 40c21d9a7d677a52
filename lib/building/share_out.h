// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

namespace ispace {

/// Value of the best layout found, and an upper bound on it, of 0, 1, 2 ... sensors on a storey, or
/// on several that see each other. More sensors than it has entries have the last one. Neither is
/// empty.
struct StoreyCurve {
    std::vector<double> values, bounds;
};

/// Numbers of sensors on the storeys.
struct SharedSensors {
    std::vector<int> counts;  ///< by storey
    double value = 0;         ///< sum of the storeys' values: the greatest of all splits
    double bound = 0;         ///< greatest sum of the storeys' bounds of all splits
};

/// Shares a number of sensors out over storeys. Values and bounds of curves add up, as no sensor
/// sees the storeys of another one; so the bound holds for every layout of that many sensors. Of
/// equally good splits, the lower storeys have more sensors. O(storeys * sensors^2)
SharedSensors shareOut(std::span<const StoreyCurve> curves, int sensors);

}  // namespace ispace
