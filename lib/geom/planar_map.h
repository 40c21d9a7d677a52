// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// End points nearer than this are one point, and an end point this near to another line lies
/// on it: walls given by length and heading meet as drawn in spite of rounding.
constexpr double kWeldDistance = 1e-6;

/// The lines with end points moved together and lines split where an end point of another touches
/// them (within kWeldDistance); zero-length pieces are dropped. `source[i]` is the index of the
/// line that piece i comes from. Deterministic; O(n log n) for lines spread over the plan.
struct WeldedLines {
    std::vector<Segment2> pieces;
    std::vector<std::size_t> source;
};
WeldedLines weld(std::span<const Segment2> lines);

/// The bounded faces into which lines divide the floor, from an exact arrangement (CGAL).
///
/// Lines may cross, overlap and dangle. A face's outline is the outer boundary of an open
/// connected piece of the floor; its holes enclose whatever lies within. Dangling and isolated
/// lines bound nothing and appear in no face. Faces come in an order that depends only on the
/// lines. O((n + crossings) log n).
std::vector<Region> boundedFaces(const WeldedLines& lines);

/// Why lines enclose nothing at a place, and the least that would cure it.
struct Gap {
    double width;      ///< metres
    Point2 place;      ///< middle of the gap
    std::size_t a, b;  ///< indices of the two lines that do not meet
};

/// The widest of the gaps that have to be closed before `inside` (or, without it, any point) is
/// enclosed, when gaps are closed from the narrowest on; nothing if closing all dangling ends
/// with their nearest line does not enclose it either.
std::optional<Gap> findGap(std::span<const Segment2> lines, std::optional<Point2> inside);

}  // namespace ispace
