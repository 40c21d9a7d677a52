// SPDX-License-Identifier: GPL-3.0-or-later
// What drawings, GeoJSON and maps need to know of an element: its colour, its lines, its area.
#pragma once

#include <cstddef>
#include <vector>

#include "draw/color.h"
#include "env/environment.h"
#include "env/material.h"
#include "plan/footprint.h"

namespace ispace {

/// The colour of a material as screens and paper have it: sRGB of its linear RGB, with its opacity.
Color displayColor(Material material);

/// What a plan draws of an element as lines: mid-lines of walls, and where doors and windows are.
struct ElementLines {
    std::vector<std::vector<Point2>> chains;  ///< closed ones end where they begin; none: no lines
    double thickness = 0;                     ///< of the wall, or through it, in metres
    double bottom = 0, top = 0;               ///< of a door or window
};

/// Of each element. O(n log n).
std::vector<ElementLines> elementLinesOf(const Environment& environment);

/// Area of a `floor` record.
Polygon floorOutline(const Record& record);

/// Segments joined where one begins at the end of the one before.
std::vector<std::vector<Point2>> chained(const std::vector<Segment2>& segments);

/// The solids of a slice, round ones inscribed in their curves, as in bands and meshes.
std::vector<Polygon> inscribedSolids(const Slice& slice);

}  // namespace ispace
