// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: half-planes that cut convex polygons.
#pragma once

#include <vector>

#include "geom/polygon.h"

namespace ispace::proofs::poses {

/// The points p with dot(normal, p) <= reach.
struct HalfPlane {
    Vec2 normal;
    double reach;
    [[nodiscard]] double beyond(Point2 p) const { return dot(normal, p - Point2()) - reach; }
    [[nodiscard]] HalfPlane opposite() const { return {-normal, -reach}; }
};

using Outline = std::vector<Point2>;

/// Clips a convex polygon to a half-plane; less than three corners become none. `spare` is memory.
void clip(Outline& polygon, const HalfPlane& half, Outline& spare);

/// Returns the area of a counter-clockwise convex polygon.
double areaOf(const Outline& polygon);

/// Returns the points left of the ray from `at`, or right of it for a negative side.
HalfPlane besideRay(Point2 at, Vec2 way, double side);

/// Returns the unit vector of a direction, in radians.
Vec2 wayAt(double angle);

/// Returns the box's corners, counter-clockwise.
Outline cornersOf(const Box2& box);

/// Returns the half-plane of this outward normal that touches the box and holds it.
HalfPlane aroundBox(const Box2& box, Vec2 normal);
/// Returns the half-plane of this outward normal that touches the box and holds no more of it.
HalfPlane behindBox(const Box2& box, Vec2 normal);

}  // namespace ispace::proofs::poses
