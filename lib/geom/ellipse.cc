// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/ellipse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/ellipse_arcs.h"

namespace ispace {

namespace {

/// Corners that keep chords within kCurveTolerance.
int cornerCount(const Ellipse& ellipse) {
    // An ellipse cut at equal steps of its parameter is a regular polygon stretched, so its chords
    // stray at most as far as those of the circle about the longer axis.
    const double radius = std::max(ellipse.half_length, ellipse.half_width);
    const double half_step = std::acos(std::max(0.0, 1 - kCurveTolerance / radius));
    const int quarter = static_cast<int>(std::ceil(std::numbers::pi / half_step / 4));
    return 4 * std::max(quarter, 2);
}

/// Of the corners of a regular polygon that has the area of the unit disc.
double cornerRadius(int count) {
    const double step = 2 * std::numbers::pi / count;
    return std::sqrt(step / std::sin(step));
}

/// \param radius of the corners in the frame in which the ellipse is the unit disc
Point2 cornerOf(const Ellipse& ellipse, double radius, int i, int count) {
    return ellipse.center +
           ellipse.fromUnit(radius * unitVector(Angle::degrees(360.0 * i / count)));
}

Polygon cornersOf(const Ellipse& ellipse, double radius) {
    const int count = cornerCount(ellipse);
    Polygon polygon;
    polygon.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) polygon.push_back(cornerOf(ellipse, radius, i, count));
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
    // Corners that are a step or more from both ends, so that what comes between bends outwards.
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
    // What is counter-clockwise about the centre lies on the right of who looks there.
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
