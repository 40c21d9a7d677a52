// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/layout only: whether things seen from above reach into each other.
#pragma once

#include <optional>

#include "env/slice.h"
#include "geom/polygon.h"

namespace ispace {

/// Things may reach into each other by this much, in metres: what is written side by side touches
/// in spite of rounding, as wall ends that are this near are welded.
constexpr double kTouching = 1e-6;

/// True if p lies deeper in the polygon than kTouching. O(n)
bool isDeepIn(const Polygon& polygon, Point2 p);

/// How far two things reach into each other, and the middle of what they share.
struct Overlap {
    double depth = 0;  ///< the shortest way that parts them, in metres
    Point2 place;
};

/// Of two convex polygons; `b` may be a line (two points). Nothing if they touch at most.
/// O(n + m)
std::optional<Overlap> overlapOf(const Polygon& a, const Polygon& b);

/// How far `b` has to move along `direction`, a unit vector, until it is beyond `a`; negative if it
/// is beyond already.
double wayBeyond(const Polygon& a, const Polygon& b, Vec2 direction);

/// A place where a line runs within a polygon, not just along its edge; nothing if it does not.
std::optional<Point2> placeWithin(const Segment2& line, const Polygon& polygon);

/// A place that a cut shares with a convex polygon or a line (two points), or nothing.
std::optional<Point2> sharedPlace(const Slice& cut, const Polygon& convex);
/// A place that two cuts share.
std::optional<Point2> sharedPlace(const Slice& a, const Slice& b);

}  // namespace ispace
