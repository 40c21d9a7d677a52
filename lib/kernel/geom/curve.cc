// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "base/parallel.h"

namespace ispace {

namespace {

/// Computes the angle that an arc spans, in [0, pi] but for rounding.
double spanOf(const CurveEdge& arc) {
    const Vec2 from = arc.from - arc.center, to = arc.to - arc.center;
    const double turn = arc.radius > 0 ? cross(from, to) : cross(to, from);
    const double span = std::atan2(turn, dot(from, to));
    if (span >= 0) return span;
    // Rounding may give slightly more than a half turn, or slightly less than zero.
    return span < -std::numbers::pi / 2 ? span + 2 * std::numbers::pi : 0;
}

/// Computes span - sin(span) without cancellation.
double sineGap(double span) {
    if (span > 0.25) return span - std::sin(span);
    const double s = span * span;
    return span * s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110))));
}

/// Computes twice the area between an arc and its chord; positive where the arc bulges to the
/// right.
double twiceBulge(const CurveEdge& arc) {
    const double twice = arc.radius * arc.radius * sineGap(spanOf(arc));
    return arc.radius > 0 ? twice : -twice;
}

void addExtremes(Box2& box, const CurveEdge& arc) {
    if (arc.from == arc.to) return;  // an arc of length zero, not a full circle
    const Vec2 from = arc.from - arc.center, to = arc.to - arc.center;
    const double radius = std::abs(arc.radius);
    const double turn = arc.radius > 0 ? 1 : -1;
    // Points computed on the circle lie off it by rounding.
    const double slack = 4 * std::numeric_limits<double>::epsilon() *
                         (std::abs(arc.center.x) + std::abs(arc.center.y) + radius);
    for (const Vec2 axis : {Vec2{1, 0}, Vec2{0, 1}, Vec2{-1, 0}, Vec2{0, -1}})
        if (turn * cross(from, axis) >= 0 && turn * cross(axis, to) >= 0)
            box.add(arc.center + (radius + slack) * axis);
}

void addVertices(Polygon& polygon, const CurveEdge& arc, double error) {
    constexpr double kMaxChords = 1 << 20;
    const double radius = std::abs(arc.radius), span = spanOf(arc);
    // The middle of a chord over the angle a is r (1 - cos(a / 2)) from the arc.
    const double step = 4 * std::asin(std::sqrt(std::min(1.0, error / (2 * radius))));
    const double count = std::min(kMaxChords, std::ceil(span / step));
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

Box2 boundsOfAll(std::span<const Curve> curves) {
    Box2 box;
    for (const Curve& curve : curves) {
        const Box2 own = bounds(curve);
        box.add(own.low);
        box.add(own.high);
    }
    return box;
}

Box2 common(const Box2& a, const Box2& b) {
    return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
            {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
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

namespace {

/// Computes the number of corners that keeps chords within kCurveTolerance.
int cornerCount(const Ellipse& ellipse) {
    // An ellipse cut at equal steps of its parameter is a regular polygon stretched, so its chords
    // stray at most as far as those of the circle about the longer axis.
    const double radius = std::max(ellipse.half_length, ellipse.half_width);
    const double half_step = std::acos(std::max(0.0, 1 - kCurveTolerance / radius));
    const int quarter = static_cast<int>(std::ceil(std::numbers::pi / half_step / 4));
    return 4 * std::max(quarter, 2);
}

/// Computes the radius of the corners of a regular polygon with the area of the unit disc.
double cornerRadius(int count) {
    const double step = 2 * std::numbers::pi / count;
    return std::sqrt(step / std::sin(step));
}

std::vector<Vec2> directionsOf(int count) {
    std::vector<Vec2> directions;
    directions.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        directions.push_back(unitVector(Angle::degrees(360.0 * i / count)));
    return directions;
}

/// Calls visit(direction) for each corner of a regular polygon. Stores the directions of polygons
/// with few corners, as furniture has. \pre count is a multiple of 4
template <typename Visit>
void forEachDirection(int count, Visit visit) {
    constexpr std::size_t kMaxQuarter = 64;
    static const std::array<Lazy<std::vector<Vec2>>, kMaxQuarter> known;
    const auto find = [count] { return directionsOf(count); };
    const auto quarter = static_cast<std::size_t>(count / 4);
    if (quarter < kMaxQuarter) {
        for (const Vec2 direction : known[quarter].get(find)) visit(direction);
    } else {
        for (const Vec2 direction : find()) visit(direction);
    }
}

/// \param radius of the corners in the frame in which the ellipse is the unit disc
Polygon cornersOf(const Ellipse& ellipse, double radius) {
    const int count = cornerCount(ellipse);
    Polygon polygon;
    polygon.reserve(static_cast<std::size_t>(count));
    forEachDirection(count, [&](Vec2 direction) {
        polygon.push_back(ellipse.center + ellipse.fromUnit(radius * direction));
    });
    return polygon;
}

Point2 placeAt(const Ellipse& ellipse, double radius, double parameter) {
    return ellipse.center +
           ellipse.fromUnit({radius * std::cos(parameter), radius * std::sin(parameter)});
}

}  // namespace

Ellipse::Ellipse(Point2 middle, double length, double width, Angle heading)
    : center(middle), axis(unitVector(heading)), half_length(length / 2), half_width(width / 2) {}

double Ellipse::heightOf(Point2 p) const {
    const Vec2 u = toUnit(p - center);
    const double size = length(u);
    if (size == 0) return -std::min(half_length, half_width);
    // (|u|^2 - 1) over the length of its gradient at the curve; for a circle |u| - 1 radii.
    return (size - 1) * size / length(normalAt(p));
}

Box2 Ellipse::box() const {
    const Vec2 across = perpendicular(axis);
    const Vec2 reach{std::hypot(half_length * axis.x, half_width * across.x),
                     std::hypot(half_length * axis.y, half_width * across.y)};
    return {center - reach, center + reach};
}

double Ellipse::area() const { return std::numbers::pi * half_length * half_width; }

Polygon inscribedIn(const Ellipse& ellipse) { return cornersOf(ellipse, 1); }

Polygon outlineOf(const Ellipse& ellipse) {
    return cornersOf(ellipse, cornerRadius(cornerCount(ellipse)));
}

double growthAround(std::size_t corners) {
    return 1 / std::cos(std::numbers::pi / static_cast<double>(corners));
}

Point2 placeOn(const Ellipse& ellipse, double parameter) { return placeAt(ellipse, 1, parameter); }

void addArc(const Ellipse& ellipse, const Polygon& outline, double from, double to,
            Polygon& polygon) {
    const auto count = static_cast<int>(outline.size());
    const double step = 2 * std::numbers::pi / count, radius = cornerRadius(count);
    const double way = to > from ? 1 : -1, span = std::fabs(to - from);
    // Corners that are a step or more from both ends, so that the points between bend outwards.
    const double ahead = way * from / step, behind = way * to / step;
    const auto first = static_cast<long>(std::ceil(ahead + 1));
    const auto last = static_cast<long>(std::floor(behind - 1));
    if (first > last) {
        // Two triangles about the centre with the area of the sector.
        polygon.push_back(placeAt(ellipse, span / 2 / std::sin(span / 2), from + way * span / 2));
        return;
    }
    const auto between = [&](double end, double corner) {
        const double half = std::fabs(corner - end) / 2;
        return placeAt(ellipse, 2 * half / ((1 + radius) * std::sin(half)), (end + corner) / 2);
    };
    polygon.push_back(between(from, way * step * static_cast<double>(first)));
    for (long k = first; k <= last; ++k) {
        const auto i = static_cast<int>((way > 0 ? k : -k) % count);
        polygon.push_back(outline[static_cast<std::size_t>(i < 0 ? i + count : i)]);
    }
    polygon.push_back(between(to, way * step * static_cast<double>(last)));
}

TouchedAt touchedFrom(const Ellipse& ellipse, Point2 viewpoint) {
    const Vec2 q = ellipse.toUnit(viewpoint - ellipse.center);
    const double middle = std::atan2(q.y, q.x), half = std::acos(std::min(1.0, 1 / length(q)));
    // Counter-clockwise about the centre is on the right as seen from the viewpoint.
    return {middle + half, middle - half};
}

Polygon outlineFrom(const Ellipse& ellipse, Point2 viewpoint) {
    if (ellipse.heightOf(viewpoint) <= 2 * kCurveTolerance) return outlineOf(ellipse);
    const auto [right, left] = touchedFrom(ellipse, viewpoint);
    const Polygon outline = outlineOf(ellipse);
    Polygon polygon{placeOn(ellipse, left)};
    addArc(ellipse, outline, left, right, polygon);
    polygon.push_back(placeOn(ellipse, right));
    addArc(ellipse, outline, right, left + 2 * std::numbers::pi, polygon);
    return polygon;
}

}  // namespace ispace
