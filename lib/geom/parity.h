// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "geom/polygon.h"

namespace ispace {

/// The thesis' Insider Judge (section 4.4.4): p is inside if the segment from p to a point known
/// to be inside crosses the wall lines an even number of times.
///
/// A crossing is counted as the thesis does, by the signs of the end points of each segment in
/// the line equation of the other, but with exact signs, and an end point on the line counts as
/// lying to its left, so that a common vertex of two walls is crossed once or twice, never by
/// half. Equals the exact test where wall lines are simple closed curves; a free-standing wall
/// between p and the known point makes it err, which the exact test does not. O(n).
bool insideByParity(Point2 p, Point2 known_inside, std::span<const Segment2> walls);

}  // namespace ispace
