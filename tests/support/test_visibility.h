// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of visibility regions: invariants and references.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "geom/predicates.h"
#include "geom/visibility/visibility.h"

namespace ispace::test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline VisibleRegion query(const std::vector<Segment2>& lines, Point2 viewpoint, double range) {
    return VisibilityMap(lines).query(viewpoint, range);
}

inline double areaSeen(const std::vector<Segment2>& lines, Point2 viewpoint, double range) {
    return area(query(lines, viewpoint, range));
}

/// Checks the guarantees that the header gives for every region; `slack` radians for directions
/// that rounding moves.
inline void expectSound(const VisibleRegion& region, double slack = 1e-9) {
    const Point2 v = region.viewpoint;
    double turned = 0;
    for (std::size_t i = 0; i < region.edges.size(); ++i) {
        const VisibilityEdge& end = region.edges[i];
        const Vec2 from = end.from - v, to = end.to - v;
        EXPECT_GT(cross(from, to), 0);
        turned += std::atan2(cross(from, to), dot(from, to));
        if (end.line == VisibilityEdge::kArc) {
            EXPECT_GE(dot(from, to), -1e-9 * dot(from, from));
            EXPECT_NEAR(length(from), region.max_range, 1e-9 * region.max_range);
            EXPECT_NEAR(length(to), region.max_range, 1e-9 * region.max_range);
        }
        const Vec2 next = region.edges[(i + 1) % region.edges.size()].from - v;
        EXPECT_NEAR(std::atan2(cross(to, next), dot(to, next)), 0, slack);
    }
    EXPECT_NEAR(turned, region.edges.empty() ? 0 : 2 * std::numbers::pi, slack);
    EXPECT_GE(area(region), 0);
    EXPECT_LE(area(region), std::numbers::pi * region.max_range * region.max_range * (1 + 1e-9));
    EXPECT_NEAR(signedArea(outlineOf(region)), area(region), 1e-9 * (1 + area(region)));
}

inline double nearest(const std::vector<Segment2>& lines, Point2 p) {
    double least = kInfinity;
    for (const Segment2& line : lines) least = std::min(least, distance(p, line));
    return least;
}

/// Computes the area by dense rays, in the middle of each piece of the turn; reach(ray) returns the
/// length of each.
template <typename Reach>
double areaByRays(int rays, Reach reach) {
    double sum = 0;
    for (int i = 0; i < rays; ++i) {
        const double angle = 2 * std::numbers::pi * (i + 0.5) / rays;
        const double far = reach(Vec2{std::cos(angle), std::sin(angle)});
        sum += far * far * std::numbers::pi / rays;
    }
    return sum;
}

/// Computes how far a ray from p goes before it meets a line, by trying each; at most `range`.
inline double reachAlong(const std::vector<Segment2>& lines, Point2 p, Vec2 ray, double range) {
    double reach = range;
    for (const auto& [a, b] : lines) {
        const double right = cross(a - p, ray), left = cross(ray, b - p);
        if ((right > 0) != (left > 0)) continue;
        const double at = cross(a - p, b - a) / cross(ray, b - a);
        if (at > 0) reach = std::min(reach, at);
    }
    return reach;
}

inline double areaByRays(const std::vector<Segment2>& lines, Point2 p, double range, int rays) {
    return areaByRays(rays, [&](Vec2 ray) { return reachAlong(lines, p, ray, range); });
}

}  // namespace ispace::test
