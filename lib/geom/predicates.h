// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "geom/polygon.h"

namespace ispace {

enum class Turn { Right = -1, Straight = 0, Left = 1 };

/// On which side of the line a -> b the point c lies; exact for the given doubles (adaptive
/// arithmetic).
Turn orientation(Point2 a, Point2 b, Point2 c);

/// True if the closed segments share a point; exact.
bool intersects(const Segment2& s, const Segment2& t);

/// Distance of p from the closed segment; rounds.
double distance(Point2 p, const Segment2& s);

/// Point of the closed segment nearest to p; rounds.
Point2 nearestPoint(const Segment2& s, Point2 p);

/// The thesis' Insider Judge (section 4.4.4): p is inside if the segment from p to a point known
/// to be inside crosses the wall lines an even number of times.
///
/// Crossings are counted as in the thesis, by the signs of each segment's end points in the line
/// equation of the other, but with exact signs. An end point on the line counts as left of it, so
/// that a vertex shared by two walls is crossed once or twice, never half. Agrees with the exact
/// test where wall lines are simple closed curves; unlike that, it errs if a free-standing wall
/// lies between p and the known point. O(n).
bool insideByParity(Point2 p, Point2 known_inside, std::span<const Segment2> walls);

}  // namespace ispace
