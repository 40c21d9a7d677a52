// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "geom/box.h"
#include "geom/polygon.h"

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

}  // namespace ispace
