// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "env/environment.h"
#include "env/openings.h"
#include "env/walls.h"
#include "geom/polygon.h"

namespace ispace {

/// Walls without thickness become this thick, in metres: readers do not recognise single faces.
constexpr double kThinWall = 0.005;

/// Walls before any opening is cut.
struct WholeWalls {
    WallPlan plan;
    std::vector<Opening> openings;
    std::vector<Body> bodies;     ///< of each line
    std::vector<double> lengths;  ///< of each body

    /// O(n log n) for n walls and openings.
    explicit WholeWalls(const std::vector<Element>& elements);
    /// Returns true if the line has a body at the opening: of coincident lines only one has.
    [[nodiscard]] bool stands(const OpeningCut& cut) const;
    /// Returns footprints of walls that have a thickness and stand on the floor.
    [[nodiscard]] std::vector<Polygon> footprints() const;
};

}  // namespace ispace
