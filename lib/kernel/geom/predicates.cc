// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>

namespace ispace {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// For p on the line through s: whether it lies between the end points.
bool within(const Segment2& s, Point2 p) {
    return std::min(s.a.x, s.b.x) <= p.x && p.x <= std::max(s.a.x, s.b.x) &&
           std::min(s.a.y, s.b.y) <= p.y && p.y <= std::max(s.a.y, s.b.y);
}

bool boxesApart(const Segment2& s, const Segment2& t) {
    return std::max(s.a.x, s.b.x) < std::min(t.a.x, t.b.x) ||
           std::max(t.a.x, t.b.x) < std::min(s.a.x, s.b.x) ||
           std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y) ||
           std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y);
}

}  // namespace

Turn orientation(Point2 a, Point2 b, Point2 c) {
    // Shewchuk's filter (1997): |error| <= (3 + 16 u) u (|left| + |right|), u = 2^-53. A small sum
    // may have underflown; an infinite one fails the comparison.
    constexpr double kError = 3.4e-16, kLeast = 1e-280;
    const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
    const double turn = left - right, sum = std::abs(left) + std::abs(right);
    if (sum > kLeast && std::abs(turn) > kError * sum) return turn > 0 ? Turn::Left : Turn::Right;
    const auto sign = CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y),
                                        Kernel::Point_2(c.x, c.y));
    return static_cast<Turn>(static_cast<int>(sign));
}

bool intersects(const Segment2& s, const Segment2& t) {
    if (boxesApart(s, t)) return false;
    const Turn ta = orientation(s.a, s.b, t.a), tb = orientation(s.a, s.b, t.b);
    const Turn sa = orientation(t.a, t.b, s.a), sb = orientation(t.a, t.b, s.b);
    if (ta == Turn::Straight && within(s, t.a)) return true;
    if (tb == Turn::Straight && within(s, t.b)) return true;
    if (sa == Turn::Straight && within(t, s.a)) return true;
    if (sb == Turn::Straight && within(t, s.b)) return true;
    // A proper crossing: each separates the end points of the other.
    return static_cast<int>(ta) * static_cast<int>(tb) < 0 &&
           static_cast<int>(sa) * static_cast<int>(sb) < 0;
}

Point2 nearestPoint(const Segment2& s, Point2 p) {
    const Vec2 along = s.b - s.a;
    const double squared = dot(along, along);
    if (!(squared > 0)) return s.a;
    const double share = dot(p - s.a, along) / squared;
    if (share <= 0) return s.a;
    if (share >= 1) return s.b;
    return s.a + share * along;
}

double distance(Point2 p, const Segment2& s) { return distance(p, nearestPoint(s, p)); }

namespace {

/// Side of line a-b on which the point lies; on the line counts as left.
bool isLeft(const Segment2& line, Point2 p) {
    return orientation(line.a, line.b, p) != Turn::Right;
}

bool crosses(const Segment2& path, const Segment2& wall) {
    return isLeft(path, wall.a) != isLeft(path, wall.b) &&
           isLeft(wall, path.a) != isLeft(wall, path.b);
}

}  // namespace

bool insideByParity(Point2 p, Point2 known_inside, std::span<const Segment2> walls) {
    const Segment2 path{p, known_inside};
    bool inside = true;
    for (const Segment2& wall : walls) {
        if (crosses(path, wall)) inside = !inside;
    }
    return inside;
}

void runUncancelled(const std::function<void()>& work) {
    tbb::task_group_context context(tbb::task_group_context::isolated);
    tbb::task_group group(context);
    group.run_and_wait(work);
}

}  // namespace ispace
