// SPDX-License-Identifier: GPL-3.0-or-later
// Closed curves of straight edges and circular arcs, ellipses, and polygons that stand for them.
//
// Areas and lengths of arcs are closed forms: a disc has the area pi r^2 up to rounding, no matter
// how it is divided. Where polygons stand for arcs the error is kChordError, for ellipses
// kCurveTolerance. Pure functions; O(edges) unless stated. Metres, square metres, x-y floor.
//
//     const Curve half{{{1, 0}, {-1, 0}, 1, {0, 0}}, {{-1, 0}, {1, 0}}};
//     const double area = signedArea(half);  // pi / 2: the arc runs counter-clockwise
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
    /// disc lies on its left), a negative one clockwise. Ends lie on the circle up to rounding;
    /// equal ends are an arc of no length, never a whole circle.
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

/// Computes the enclosed area, m2, positive if counter-clockwise; in closed form, arcs included.
/// Sums from the first vertex on, and r^2 (a - sin a) / 2 of flat arcs by a series, so that neither
/// distance from the origin nor a flat arc costs digits. Parts of a curve that crosses itself count
/// by their winding numbers. 0 for an empty curve.
double signedArea(const Curve& curve);
double signedArea(std::span<const Curve> curves);
/// Computes the length of all edges, m.
double perimeter(const Curve& curve);
double perimeter(std::span<const Curve> curves);
/// Returns a box that contains the curve; around arcs it may be larger than necessary, by rounding.
Box2 bounds(const Curve& curve);
/// Returns the bounding box of all curves.
Box2 boundsOfAll(std::span<const Curve> curves);
/// Returns the common part of two boxes; if they are disjoint, low exceeds high in x or in y.
Box2 common(const Box2& a, const Box2& b);

/// Replaces arcs by chords: vertices lie on the arcs, chords at most `error` from them, all chords
/// of an arc equally long. A chord over the angle a is r (1 - cos(a / 2)) from its arc, so an arc
/// over s takes about s sqrt(r / (8 error)) of them; at most 2^20.
Polygon chords(const Curve& curve, double error = kChordError);
/// Converts a polygon to straight edges.
Curve curveOf(const Polygon& polygon);
/// Converts the outline and the holes.
std::vector<Curve> curvesWithArcs(const Region& region);
std::vector<Curve> curvesWithArcs(const Regions& regions);

/// A closed ellipse: the footprint of a round body.
///
///     const Ellipse table({2, 1}, 1.6, 0.9, Angle::degrees(30));
///     const bool is_inside = table.heightOf({2.2, 1.1}) < 0;
///
/// \pre half_length > 0 and half_width > 0
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
/// end in vertices, so the bounding box is the curve's if it lies along the axes.
/// Counter-clockwise, at most kCurveTolerance inside the curve: an ellipse at equal steps of its
/// parameter is a regular polygon stretched, and its chords stray at most as far as those of the
/// circle about the longer axis. About 314 sqrt(R) vertices, R the longer half axis in metres; at
/// least 8.
Polygon inscribedIn(const Ellipse& ellipse);
/// The same polygon scaled about the centre to the area of the ellipse, up to rounding: its edges
/// cross the curve.
Polygon outlineOf(const Ellipse& ellipse);
/// Factor by which an inscribed polygon must be scaled about the centre to contain its ellipse.
double growthAround(std::size_t corners);

// Points on an ellipse by their parameter, in radians: the angle about the centre in the frame in
// which the ellipse is the unit disc. All round.

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
