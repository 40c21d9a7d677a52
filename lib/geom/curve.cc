// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ispace {

namespace {

/// Angle that an arc spans, in [0, pi] but for rounding.
double spanOf(const CurveEdge& arc) {
    const Vec2 from = arc.from - arc.center, to = arc.to - arc.center;
    const double turn = arc.radius > 0 ? cross(from, to) : cross(to, from);
    const double span = std::atan2(turn, dot(from, to));
    if (span >= 0) return span;
    // Rounding: a little more than a half turn, or a little less than nothing.
    return span < -std::numbers::pi / 2 ? span + 2 * std::numbers::pi : 0;
}

/// span - sin(span), without cancellation.
double sineGap(double span) {
    if (span > 0.25) return span - std::sin(span);
    const double s = span * span;
    return span * s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110))));
}

/// Twice the area between an arc and its chord; positive where the arc bulges to the right.
double twiceBulge(const CurveEdge& arc) {
    const double twice = arc.radius * arc.radius * sineGap(spanOf(arc));
    return arc.radius > 0 ? twice : -twice;
}

void addExtremes(Box2& box, const CurveEdge& arc) {
    if (arc.from == arc.to) return;  // no way round, not all of it
    const Vec2 from = arc.from - arc.center, to = arc.to - arc.center;
    const double radius = std::abs(arc.radius);
    const double turn = arc.radius > 0 ? 1 : -1;
    // Points made on the circle lie off it by rounding.
    const double slack = 4 * std::numeric_limits<double>::epsilon() *
                         (std::abs(arc.center.x) + std::abs(arc.center.y) + radius);
    for (const Vec2 axis : {Vec2{1, 0}, Vec2{0, 1}, Vec2{-1, 0}, Vec2{0, -1}})
        if (turn * cross(from, axis) >= 0 && turn * cross(axis, to) >= 0)
            box.add(arc.center + (radius + slack) * axis);
}

void addVertices(Polygon& polygon, const CurveEdge& arc, double error) {
    constexpr double kMostChords = 1 << 20;
    const double radius = std::abs(arc.radius), span = spanOf(arc);
    // The middle of a chord over an angle a lies r (1 - cos(a / 2)) from the arc.
    const double step = 4 * std::asin(std::sqrt(std::min(1.0, error / (2 * radius))));
    const double count = std::min(kMostChords, std::ceil(span / step));
    const Vec2 from = arc.from - arc.center;
    const double turn = arc.radius > 0 ? 1 : -1;
    for (double i = 1; i < count; ++i) {
        const double angle = turn * span * (i / count);
        const double c = std::cos(angle), s = std::sin(angle);
        polygon.push_back(arc.center + Vec2{c * from.x - s * from.y, s * from.x + c * from.y});
    }
}

}  // namespace

double signedArea(const Curve& curve) {
    double twice = 0;
    // Relative to the first vertex, so that a small curve far from the origin keeps its digits.
    for (const CurveEdge& edge : curve) {
        twice += cross(edge.from - curve[0].from, edge.to - curve[0].from);
        if (edge.isArc()) twice += twiceBulge(edge);
    }
    return twice / 2;
}

double signedArea(std::span<const Curve> curves) {
    double sum = 0;
    for (const Curve& curve : curves) sum += signedArea(curve);
    return sum;
}

double perimeter(const Curve& curve) {
    double sum = 0;
    for (const CurveEdge& edge : curve)
        sum += edge.isArc() ? std::abs(edge.radius) * spanOf(edge) : distance(edge.from, edge.to);
    return sum;
}

double perimeter(std::span<const Curve> curves) {
    double sum = 0;
    for (const Curve& curve : curves) sum += perimeter(curve);
    return sum;
}

Box2 bounds(const Curve& curve) {
    Box2 box;
    for (const CurveEdge& edge : curve) {
        box.add(edge.from);
        if (edge.isArc()) addExtremes(box, edge);
    }
    return box;
}

Polygon chords(const Curve& curve, double error) {
    Polygon polygon;
    polygon.reserve(curve.size());
    for (const CurveEdge& edge : curve) {
        polygon.push_back(edge.from);
        if (edge.isArc()) addVertices(polygon, edge, error);
    }
    return polygon;
}

Curve curveOf(const Polygon& polygon) {
    Curve curve;
    curve.reserve(polygon.size());
    forEachEdge(polygon, [&](const Segment2& edge) { curve.push_back({edge.a, edge.b}); });
    return curve;
}

std::vector<Curve> curvesWithArcs(const Region& region) {
    std::vector<Curve> curves;
    curves.reserve(region.holes.size() + 1);
    curves.push_back(curveOf(region.outline));
    for (const Polygon& hole : region.holes) curves.push_back(curveOf(hole));
    return curves;
}

std::vector<Curve> curvesWithArcs(const Regions& regions) {
    std::vector<Curve> curves;
    for (const Region& part : regions.parts)
        for (Curve& curve : curvesWithArcs(part)) curves.push_back(std::move(curve));
    return curves;
}

}  // namespace ispace
