// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>

#include "geom/predicates.h"

namespace ispace {

namespace {

/// How an edge meets the ray that leaves p towards +x, end points by the half-open rule.
enum class Meeting { None, Crossing, Touches };

Meeting meetRay(const Segment2& edge, Point2 p) {
    const auto& [a, b] = edge;
    if (p == a || p == b) return Meeting::Touches;
    const double low_x = std::min(a.x, b.x), high_x = std::max(a.x, b.x);
    if ((a.y > p.y) == (b.y > p.y)) {
        const bool along = a.y == p.y && b.y == p.y && low_x <= p.x && p.x <= high_x;
        return along ? Meeting::Touches : Meeting::None;
    }
    if (p.x > high_x) return Meeting::None;
    if (p.x < low_x) return Meeting::Crossing;
    const Turn turn = a.y < b.y ? orientation(a, b, p) : orientation(b, a, p);
    if (turn == Turn::Straight) return Meeting::Touches;
    return turn == Turn::Left ? Meeting::Crossing : Meeting::None;
}

/// True if `test` holds of the turn at every corner.
template <typename Test>
bool everyTurn(const Polygon& polygon, Test test) {
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i)
        if (!test(orientation(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n])))
            return false;
    return true;
}

void addCurves(std::vector<Polygon>& curves, const Region& region) {
    curves.push_back(region.outline);
    curves.insert(curves.end(), region.holes.begin(), region.holes.end());
}

}  // namespace

double signedArea(const Polygon& polygon) {
    double twice = 0;
    // Relative to the first vertex, so that a small polygon far from the origin keeps its digits.
    for (std::size_t i = 2; i < polygon.size(); ++i)
        twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return twice / 2;
}

double perimeter(const Polygon& polygon) {
    double sum = 0;
    forEachEdge(polygon, [&](const Segment2& edge) { sum += distance(edge.a, edge.b); });
    return sum;
}

Box2 bounds(const Polygon& polygon) {
    Box2 box;
    for (const Point2 p : polygon) box.add(p);
    return box;
}

Box2 bounds(const Segment2& segment) {
    Box2 box;
    box.add(segment.a);
    box.add(segment.b);
    return box;
}

bool isConvex(const Polygon& polygon) {
    bool turns = false;
    const auto is_allowed = [&turns](Turn turn) {
        turns = turns || turn == Turn::Left;
        return turn != Turn::Right;
    };
    return everyTurn(polygon, is_allowed) && turns;
}

bool isStrictlyConvex(const Polygon& polygon) {
    return !polygon.empty() && everyTurn(polygon, [](Turn turn) { return turn == Turn::Left; });
}

Side locate(const Polygon& polygon, Point2 p) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 next = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        const Meeting meeting = meetRay({polygon[i], next}, p);
        if (meeting == Meeting::Touches) return Side::Boundary;
        if (meeting == Meeting::Crossing) inside = !inside;
    }
    return inside ? Side::Inside : Side::Outside;
}

std::vector<Polygon> curvesOf(const Region& region) {
    std::vector<Polygon> curves;
    addCurves(curves, region);
    return curves;
}

std::vector<Polygon> curvesOf(const std::vector<Region>& regions) {
    std::vector<Polygon> curves;
    for (const Region& region : regions) addCurves(curves, region);
    return curves;
}

std::vector<Polygon> curvesOf(const Regions& regions) { return curvesOf(regions.parts); }

Box2 bounds(const Regions& regions) {
    Box2 box;
    for (const Region& part : regions.parts)
        for (const Point2 p : part.outline) box.add(p);
    return box;
}

double Region::area() const {
    double sum = std::abs(signedArea(outline));
    for (const Polygon& hole : holes) sum -= std::abs(signedArea(hole));
    return sum;
}

double Region::boundaryLength() const {
    double sum = perimeter(outline);
    for (const Polygon& hole : holes) sum += perimeter(hole);
    return sum;
}

Side Region::locate(Point2 p) const {
    const Side side = ispace::locate(outline, p);
    if (side != Side::Inside) return side;
    for (const Polygon& hole : holes) {
        const Side in_hole = ispace::locate(hole, p);
        if (in_hole == Side::Boundary) return Side::Boundary;
        if (in_hole == Side::Inside) return Side::Outside;
    }
    return Side::Inside;
}

double Regions::area() const {
    double sum = 0;
    for (const Region& part : parts) sum += part.area();
    return sum;
}

double Regions::boundaryLength() const {
    double sum = 0;
    for (const Region& part : parts) sum += part.boundaryLength();
    return sum;
}

Side Regions::locate(Point2 p) const {
    Side side = Side::Outside;
    for (const Region& part : parts) {
        const Side in_part = part.locate(p);
        if (in_part == Side::Inside) return Side::Inside;
        if (in_part == Side::Boundary) side = Side::Boundary;
    }
    return side;
}

}  // namespace ispace
