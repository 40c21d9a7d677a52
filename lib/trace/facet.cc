// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/facet.h"

#include <algorithm>
#include <cmath>

namespace ispace {

namespace {

double dot(Vec3 v, Point3 p) { return v.x * p.x + v.y * p.y + v.z * p.z; }

Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double distanceToSegment(Point3 p, Point3 a, Point3 b) {
    const Vec3 along = b - a;
    const double square = dot(along, along);
    const double share = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0.0;
    return length(p - (a + share * along));
}

}  // namespace

Facet Facet::ofLine(Point2 a, Point2 b) {
    Facet facet;
    const Vec2 along = b - a;
    facet.size = length(along);
    facet.corners = {Point3{a.x, a.y, 0}, Point3{b.x, b.y, 0}, Point3{b.x, b.y, 0}};
    if (facet.size == 0) return facet;
    facet.normal = {-along.y / facet.size, along.x / facet.size, 0};
    facet.offset = dot(facet.normal, facet.corners[0]);
    return facet;
}

Facet Facet::ofTriangle(Point3 a, Point3 b, Point3 c) {
    Facet facet;
    facet.size = std::max({length(b - a), length(c - b), length(a - c)});
    facet.corners = {a, b, c};
    const Vec3 normal = cross(b - a, c - a);
    const double twice_area = length(normal);
    if (twice_area == 0) return facet;
    facet.normal = {normal.x / twice_area, normal.y / twice_area, normal.z / twice_area};
    facet.offset = dot(facet.normal, a);
    return facet;
}

double Facet::distanceAlong(Point3 origin, Vec3 direction) const {
    const double first = dot(corners[0] - origin, direction);
    const double second = dot(corners[1] - origin, direction);
    const double third = dot(corners[2] - origin, direction);
    const double low = std::min({first, second, third});
    const double slope = dot(normal, direction);
    if (slope == 0) return low;
    const double t = (offset - dot(normal, origin)) / slope;
    return std::clamp(t, low, std::max({first, second, third}));
}

bool Facet::isEdgeOn(Vec3 direction, double slack) const {
    // A speck that is smaller than the slack is not always seen from its edge.
    constexpr double kFlattest = 1e-3;
    const double slope = std::fabs(dot(normal, direction));
    return slope * size < slack && slope < kFlattest;
}

double Facet::distanceTo(Point3 p) const {
    const auto& [a, b, c] = corners;
    const double above = dot(normal, p) - offset;
    const bool is_line = b == c;
    const auto is_left = [&](Point3 from, Point3 to) {
        return dot(cross(to - from, p - from), normal) >= 0;
    };
    if (!is_line && is_left(a, b) && is_left(b, c) && is_left(c, a)) return std::fabs(above);
    if (is_line) return distanceToSegment(p, a, b);
    return std::min(
        {distanceToSegment(p, a, b), distanceToSegment(p, b, c), distanceToSegment(p, c, a)});
}

}  // namespace ispace
