// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "io/dxf_shapes.h"

namespace ispace {

/// A door or a window of a drawing.
struct PlanOpening {
    Segment2 line;                    ///< ends on walls, or at ends of walls
    std::optional<std::size_t> wall;  ///< the wall piece it lies on; none: it closes a gap
    bool is_window = false;
    int drawn_on = 0;  ///< line of the file
};

/// What the symbols of doors and windows mean.
struct PlanOpenings {
    std::vector<PlanOpening> openings;
    std::size_t unused = 0;  ///< symbols that span nothing
};

/// Finds the openings that symbols stand for, doors first.
///
/// A straight piece is an opening where both of its ends are at walls (within 0.1 m): across a gap,
/// or along one wall. An arc is the swing of a leaf, hinged at its centre: the opening runs from
/// there to that end of the arc which is at a wall, and lines to its other end are the leaf; two
/// arcs that meet in the air are a double door, open from hinge to hinge. Openings are 0.4 m wide
/// or more; none is found twice, and none overlaps another on its wall.
PlanOpenings findOpenings(std::span<const PlanShape> doors, std::span<const PlanShape> windows,
                          std::span<const Segment2> walls);

}  // namespace ispace
