// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/point.h"
#include "geom/polygon.h"
#include "geom/pose.h"

namespace ispace {

/// An edge of a closed curve: straight, or a circular arc of at most a half turn.
struct CurveEdge {
    Point2 from, to;
    /// Radius of the arc; 0: straight. A positive arc runs counter-clockwise about `center` (the
    /// disc lies on its left), a negative one clockwise.
    double radius = 0;
    Point2 center = {};

    [[nodiscard]] bool isArc() const { return radius != 0; }
    friend bool operator==(const CurveEdge&, const CurveEdge&) = default;
};

/// A closed curve of straight edges and arcs. Each edge begins where the previous one ends; the
/// enclosed area lies on the left (outlines run counter-clockwise, holes clockwise).
using Curve = std::vector<CurveEdge>;

/// Default maximum distance of a chord from its arc, in metres.
constexpr double kChordError = 1e-4;

/// Computes the enclosed area, positive if counter-clockwise; in closed form, arcs included.
double signedArea(const Curve& curve);
double signedArea(std::span<const Curve> curves);
double perimeter(const Curve& curve);
double perimeter(std::span<const Curve> curves);
/// Returns a box that contains the curve; around arcs it may be larger than necessary.
Box2 bounds(const Curve& curve);
/// Returns the bounding box of all curves.
Box2 boundsOfAll(std::span<const Curve> curves);
/// Returns the common part of two boxes; if they are disjoint, low exceeds high in x or in y.
Box2 common(const Box2& a, const Box2& b);

/// Replaces arcs by chords: vertices lie on the arcs, chords at most `error` from them.
Polygon chords(const Curve& curve, double error = kChordError);
/// Converts a polygon to straight edges.
Curve curveOf(const Polygon& polygon);
/// Converts the outline and the holes.
std::vector<Curve> curvesWithArcs(const Region& region);
std::vector<Curve> curvesWithArcs(const Regions& regions);

/// A closed ellipse: the footprint of a round body.
struct Ellipse {
    Point2 center;
    Vec2 axis{1, 0};  ///< unit vector along its length
    double half_length = 0, half_width = 0;

    Ellipse() = default;
    /// Lengths of the full axes; the first lies along `heading`.
    Ellipse(Point2 middle, double length, double width, Angle heading);

    /// Maps a vector to the frame in which the ellipse is the unit disc, and back.
    [[nodiscard]] Vec2 toUnit(Vec2 v) const {
        return {dot(axis, v) / half_length, cross(axis, v) / half_width};
    }
    [[nodiscard]] Vec2 fromUnit(Vec2 u) const {
        return half_length * u.x * axis + half_width * u.y * perpendicular(axis);
    }
    /// Outward normal at p of the concentric ellipse of this shape through p; not normalised, null
    /// at the centre.
    [[nodiscard]] Vec2 normalAt(Point2 p) const {
        const Vec2 u = toUnit(p - center);
        return u.x / half_length * axis + u.y / half_width * perpendicular(axis);
    }
    /// Signed distance of p from the curve, negative inside: exact for circles, to first order near
    /// any ellipse. Elsewhere only the sign is meaningful.
    [[nodiscard]] double heightOf(Point2 p) const;
    /// Returns the bounding box.
    [[nodiscard]] Box2 box() const;
    [[nodiscard]] double area() const;

    friend bool operator==(const Ellipse&, const Ellipse&) = default;
};

/// Maximum distance between an ellipse and the polygons that approximate it, in metres. Rays, lines
/// of sight and floor areas use the curve itself or a polygon of the same area; meshes, drawings,
/// collisions and contacts use the inscribed one.
constexpr double kCurveTolerance = 0.00005;

/// Computes vertices on the curve, a multiple of four at equal steps of the parameter: both axes
/// end in vertices, so the bounding box is the curve's. Counter-clockwise, at most kCurveTolerance
/// inside the curve.
Polygon inscribedIn(const Ellipse& ellipse);
/// The same polygon scaled about the centre to the area of the ellipse: its edges cross the curve.
Polygon outlineOf(const Ellipse& ellipse);
/// Factor by which an inscribed polygon must be scaled about the centre to contain its ellipse.
double growthAround(std::size_t corners);

// Points on an ellipse by their parameter, in radians: the angle about the centre in the frame in
// which the ellipse is the unit disc.

Point2 placeOn(const Ellipse& ellipse, double parameter);

/// Appends points close to the arc from one parameter to another, ascending or descending, without
/// either end: together with the ends they enclose the same area as the arc. All but the first and
/// last are vertices of `outline`, which is outlineOf(ellipse).
void addArc(const Ellipse& ellipse, const Polygon& outline, double from, double to,
            Polygon& polygon);

/// Computes the parameters at which the tangents from an outside point touch an ellipse, on the
/// viewer's right and left; the near side lies between them, left < right < left + pi.
struct TouchedAt {
    double right, left;
};
TouchedAt touchedFrom(const Ellipse& ellipse, Point2 viewpoint);

/// A convex polygon of the same area with vertices where the tangents from the viewpoint touch the
/// ellipse; outlineOf() for viewpoints inside or within twice kCurveTolerance of the curve.
Polygon outlineFrom(const Ellipse& ellipse, Point2 viewpoint);

}  // namespace ispace
