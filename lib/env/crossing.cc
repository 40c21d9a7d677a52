// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/crossing.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "geom/predicates.h"

namespace ispace {

namespace {

/// True if each segment has its ends strictly on both sides of the other.
bool crosses(const Segment2& s, const Segment2& t) {
    if (std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y) ||
        std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y))
        return false;
    const auto parts = [](const Segment2& line, const Segment2& other) {
        const Turn a = orientation(line.a, line.b, other.a);
        const Turn b = orientation(line.a, line.b, other.b);
        return a != Turn::Straight && b != Turn::Straight && a != b;
    };
    return parts(s, t) && parts(t, s);
}

Point2 crossingPoint(const Segment2& s, const Segment2& t) {
    const Vec2 along = s.b - s.a, other = t.b - t.a;
    return s.a + cross(t.a - s.a, other) / cross(along, other) * along;
}

double lowX(const Segment2& s) { return std::min(s.a.x, s.b.x); }
double highX(const Segment2& s) { return std::max(s.a.x, s.b.x); }

}  // namespace

std::optional<Point2> selfCrossing(const Polygon& polygon) {
    std::vector<Segment2> edges;
    edges.reserve(polygon.size());
    forEachEdge(polygon, [&edges](const Segment2& edge) { edges.push_back(edge); });
    std::stable_sort(edges.begin(), edges.end(),
                     [](const Segment2& s, const Segment2& t) { return lowX(s) < lowX(t); });
    std::vector<Segment2> open;
    for (const Segment2& edge : edges) {
        std::erase_if(open, [&](const Segment2& s) { return highX(s) < lowX(edge); });
        for (const Segment2& s : open)
            if (crosses(s, edge)) return crossingPoint(s, edge);
        open.push_back(edge);
    }
    return std::nullopt;
}

}  // namespace ispace
