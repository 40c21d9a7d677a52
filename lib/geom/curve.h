// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/box.h"
#include "geom/polygon.h"
#include "geom/pose.h"

namespace ispace {

/// An edge of a closed curve: straight, or a circular arc of at most a half turn.
struct CurveEdge {
    Point2 from, to;
    /// Of the circle; 0: straight. Above 0 the arc runs counter-clockwise about `center` (the disc
    /// lies on its left), below 0 clockwise.
    double radius = 0;
    Point2 center = {};

    [[nodiscard]] bool isArc() const { return radius != 0; }
    friend bool operator==(const CurveEdge&, const CurveEdge&) = default;
};

/// A closed curve of straight edges and arcs; each edge begins where the one before it ends, and
/// what it encloses lies on its left (outlines counter-clockwise, holes clockwise).
using Curve = std::vector<CurveEdge>;

/// How far a chord may lie from its arc unless somebody says otherwise, in metres.
constexpr double kChordError = 1e-4;

/// Area enclosed, positive if counter-clockwise; in closed form, arcs included.
double signedArea(const Curve& curve);
double signedArea(std::span<const Curve> curves);
double perimeter(const Curve& curve);
double perimeter(std::span<const Curve> curves);
/// A box that holds the curve; arcs may lie clear of its sides.
Box2 bounds(const Curve& curve);

/// The same curve with chords for arcs, vertices on the arcs, none farther from them than `error`.
Polygon chords(const Curve& curve, double error = kChordError);
/// Straight edges only.
Curve curveOf(const Polygon& polygon);
/// Outline and holes.
std::vector<Curve> curvesWithArcs(const Region& region);
std::vector<Curve> curvesWithArcs(const Regions& regions);

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

// Places on an ellipse by their parameter, in radians: the angle about the centre in the frame that
// makes it the unit disc.

Point2 placeOn(const Ellipse& ellipse, double parameter);

/// Adds places next to the arc from one parameter to another, ascending or descending, neither end
/// among them: between the ends they enclose the area that the arc does. But for the first and the
/// last they are corners of `outline`, which is outlineOf(ellipse).
void addArc(const Ellipse& ellipse, const Polygon& outline, double from, double to,
            Polygon& polygon);

/// Where lines of sight from outside touch an ellipse, on the viewer's right and left; the near
/// side lies between them, left < right < left + pi.
struct TouchedAt {
    double right, left;
};
TouchedAt touchedFrom(const Ellipse& ellipse, Point2 viewpoint);

/// A convex polygon of the same area with corners where lines of sight from outside touch the
/// ellipse; from inside, or as near to the curve as twice kCurveTolerance, outlineOf().
Polygon outlineFrom(const Ellipse& ellipse, Point2 viewpoint);

}  // namespace ispace
