// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/polygon.h"

namespace ispace {

enum class Turn { Right = -1, Straight = 0, Left = 1 };

/// Where c lies seen along a -> b; exact for the given doubles (adaptive arithmetic).
Turn orientation(Point2 a, Point2 b, Point2 c);

/// True if the closed segments share a point; exact.
bool intersects(const Segment2& s, const Segment2& t);

/// Distance of p from the closed segment; rounds.
double distance(Point2 p, const Segment2& s);

/// Point of the closed segment nearest to p; rounds.
Point2 nearestPoint(const Segment2& s, Point2 p);

}  // namespace ispace
