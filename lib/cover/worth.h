// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "cover/target.h"
#include "cover/zone.h"

namespace ispace {

/// What floor is worth to somebody: by default all indoor floor the same.
struct Worth {
    std::vector<NamedZone> targets;  ///< only floor in one of them counts; none: all
    std::vector<std::pair<NamedZone, double>>
        weights;  ///< the last that holds a place decides; else 1

    [[nodiscard]] bool isUniform() const { return targets.empty() && weights.empty(); }
};

/// Worth of each cell of the target's grid: 0 outside of the indoor region and of all targets. A
/// cell counts by its centre, strictly inside.
std::vector<double> worthOfCells(const Target& target, const Worth& worth);

}  // namespace ispace
