// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "geom/box.h"
#include "geom/polygon.h"
#include "geom/pose.h"

namespace ispace {

/// A closed disc, or one stretched along its axes: what round bodies are on the floor.
struct Ellipse {
    Point2 center;
    Vec2 axis{1, 0};  ///< unit vector along its length
    double half_length = 0, half_width = 0;

    Ellipse() = default;
    /// Full axes, the first along `heading`.
    Ellipse(Point2 middle, double length, double width, Angle heading);

    /// A vector in the frame that makes it the unit disc, and back.
    [[nodiscard]] Vec2 toUnit(Vec2 v) const {
        return {dot(axis, v) / half_length, cross(axis, v) / half_width};
    }
    [[nodiscard]] Vec2 fromUnit(Vec2 u) const {
        return half_length * u.x * axis + half_width * u.y * perpendicular(axis);
    }
    /// Outward normal of the ellipse of this shape through p, of any length; null at the centre.
    [[nodiscard]] Vec2 normalAt(Point2 p) const {
        const Vec2 u = toUnit(p - center);
        return u.x / half_length * axis + u.y / half_width * perpendicular(axis);
    }
    /// How far p lies outside of the curve, negative inside: for a circle, and near to any curve to
    /// first order of that distance. Elsewhere only the sign counts.
    [[nodiscard]] double heightOf(Point2 p) const;
    /// The least box that holds it.
    [[nodiscard]] Box2 box() const;
    [[nodiscard]] double area() const;

    friend bool operator==(const Ellipse&, const Ellipse&) = default;
};

/// Greatest distance between an ellipse and the polygons that stand for it, in metres. Rays, lines
/// of sight and areas of the floor go by the curve itself, or by a polygon of the same area;
/// meshes, drawings, collisions and what things touch go by the inscribed one.
constexpr double kCurveTolerance = 0.00005;

/// Corners on the curve, a multiple of four at equal steps of the parameter: both axes end in
/// corners, so that the bounding box is the curve's. Counter-clockwise, and at most kCurveTolerance
/// within the curve.
Polygon inscribedIn(const Ellipse& ellipse);
/// The same made larger about the centre, to the very area of the ellipse: its edges run to both
/// sides of the curve.
Polygon outlineOf(const Ellipse& ellipse);
/// How much larger about the centre an inscribed polygon has to be to hold its ellipse.
double growthAround(std::size_t corners);

}  // namespace ispace
