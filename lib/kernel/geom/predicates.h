// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/kernel/geom: exact predicates, and the sign of the in-circle determinant in
// double-double arithmetic.
//
// Guarantees. orientation() and intersects() return the sign of the real-number formula for the
// doubles given, for any finite coordinates: neither overflow nor underflow nor collinear input
// changes it. Functions that compute a point or a distance round, and say so. All are pure
// functions: thread-safe, the same result on every run.
//
// Method: a floating-point filter with a forward error bound, exact numbers where the filter fails
// (J. R. Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric
// predicates, 1997; exact numbers are CGAL's). The filter decides all but nearly collinear triples
// with five subtractions and two products.
//
//     const Turn turn = orientation({0, 0}, {1, 0}, {1, 1});         // Turn::Left
//     const bool meet = intersects({{0, 0}, {2, 2}}, {{0, 2}, {2, 0}});  // true
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "geom/point.h"
#include "geom/polygon.h"

namespace ispace {

/// Side of a directed line on which a point lies; Left is counter-clockwise.
enum class Turn { Right = -1, Straight = 0, Left = 1 };

/// Computes on which side of the line a -> b the point c lies: the sign of
/// (a - c) x (b - c), exact for the given doubles. Straight if a == b.
///
/// Filter: with u = 2^-53 the determinant of rounded differences errs by at most
/// (3 + 16 u) u < 3.4e-16 of the sum of the magnitudes of its two products (Shewchuk 1997), unless
/// a product underflows; sums below 1e-280 go to exact numbers.
/// \pre coordinates are finite
Turn orientation(Point2 a, Point2 b, Point2 c);

/// True if the closed segments share a point; exact. Segments may touch, overlap, or have zero
/// length (a point). Symmetric in s and t.
bool intersects(const Segment2& s, const Segment2& t);

/// Computes the distance of p from the closed segment, in metres; that of nearestPoint(), so it
/// errs by some ulp of the coordinates. A segment of zero length is its point a.
double distance(Point2 p, const Segment2& s);

/// Computes the point of the closed segment nearest to p: an end exactly where an end is nearest,
/// else rounded, by some ulp of the coordinates off the line.
Point2 nearestPoint(const Segment2& s, Point2 p);

/// The thesis' Insider Judge (section 4.4.4): p is inside if the segment from p to a point known
/// to be inside crosses the wall lines an even number of times.
///
/// Crossings are counted as in the thesis, by the signs of each segment's end points in the line
/// equation of the other, but with exact signs. An end point on the line counts as left of it, so
/// that a vertex shared by two walls is crossed once or twice, never half. Agrees with the exact
/// test where wall lines are simple closed curves; unlike that, it errs if a free-standing wall
/// lies between p and the known point. O(n): four orientations a wall, no index. For many queries
/// use RegionIndex of env/point_location.h.
bool insideByParity(Point2 p, Point2 known_inside, std::span<const Segment2> walls);

/// An unevaluated sum of two doubles, the second at most half an ulp of the first: some 106 bits
/// (T. J. Dekker, A floating-point technique for extending the available precision, 1971). A
/// product or sum errs by at most 2^-102 of its operands' magnitudes. Has neither comparisons nor
/// division. Overflow gives NaN in `low`.
struct DoublePair {
    double high = 0, low = 0;

    /// Exact, unless it overflows.
    static DoublePair differenceOf(double a, double b) {
        const double high = a - b, taken = a - high;
        return {high, (a - (high + taken)) + (taken - b)};
    }
    friend DoublePair operator+(DoublePair a, DoublePair b) {
        const double sum = a.high + b.high, part = sum - a.high;
        const double rest = ((a.high - (sum - part)) + (b.high - part)) + (a.low + b.low);
        const double high = sum + rest;
        return {high, rest - (high - sum)};
    }
    friend DoublePair operator-(DoublePair a) { return {-a.high, -a.low}; }
    friend DoublePair operator*(DoublePair a, DoublePair b) {
        const double product = a.high * b.high;
        const double rest = std::fma(a.high, b.high, -product) + (a.high * b.low + a.low * b.high);
        const double high = product + rest;
        return {high, rest - (high - product)};
    }
};

/// Computes surelyInCircle() in doubles if they suffice, else 0: the first stage of Shewchuk's
/// filter (1997), which errs by at most (10 + 96 u) u, u = 2^-53, of the determinant's permanent;
/// 12 u is used here.
inline int roughlyInCircle(Point2 a, Point2 b, Point2 c, Point2 d) {
    const Vec2 u = a - d, v = b - d, w = c - d;
    const double vw = v.x * w.y, wv = w.x * v.y, wu = w.x * u.y, uw = u.x * w.y;
    const double uv = u.x * v.y, vu = v.x * u.y;
    const double u_lift = dot(u, u), v_lift = dot(v, v), w_lift = dot(w, w);
    const double det = u_lift * (vw - wv) + v_lift * (wu - uw) + w_lift * (uv - vu);
    const double all = (std::abs(vw) + std::abs(wv)) * u_lift +
                       (std::abs(wu) + std::abs(uw)) * v_lift +
                       (std::abs(uv) + std::abs(vu)) * w_lift;
    constexpr double kError = 12 * 0x1p-53, kMinValue = 0x1p-600, kMaxValue = 0x1p1000;
    if (!(all > kMinValue && all < kMaxValue)) return 0;
    return det > kError * all ? 1 : det < -kError * all ? -1 : 0;
}

/// Positive if d surely lies within the circle through a, b, c (counter-clockwise), negative if
/// surely outside, 0 if it may lie on it: nearer than some 2^-90 of the extent, or where numbers
/// are so large or small that products leave the range of doubles. A caller that needs the sign of
/// a 0 asks exact numbers. Pairs of doubles take 50 ns, a sixth of the time of these, and decide
/// rectangles with rotated and rounded corners: 0 remains for those on one circle exactly.
inline int surelyInCircle(Point2 a, Point2 b, Point2 c, Point2 d) {
    if (const int side = roughlyInCircle(a, b, c, d); side != 0) return side;
    using Pair = DoublePair;
    const Pair ax = Pair::differenceOf(a.x, d.x), ay = Pair::differenceOf(a.y, d.y);
    const Pair bx = Pair::differenceOf(b.x, d.x), by = Pair::differenceOf(b.y, d.y);
    const Pair cx = Pair::differenceOf(c.x, d.x), cy = Pair::differenceOf(c.y, d.y);
    const auto lift = [](Pair x, Pair y) { return x * x + y * y; };
    const auto turn = [](Pair x, Pair y, Pair u, Pair v) { return x * v + -(y * u); };
    const Pair a_lift = lift(ax, ay), b_lift = lift(bx, by), c_lift = lift(cx, cy);
    const Pair det = a_lift * turn(bx, by, cx, cy) +
                     (b_lift * turn(cx, cy, ax, ay) + c_lift * turn(ax, ay, bx, by));
    const auto most = [](Pair x, Pair y, Pair u, Pair v) {
        return std::abs(x.high * v.high) + std::abs(y.high * u.high);
    };
    const double all = a_lift.high * most(bx, by, cx, cy) + b_lift.high * most(cx, cy, ax, ay) +
                       c_lift.high * most(ax, ay, bx, by);
    // Some 20 roundings, each off by 2^-102 of its operands at most. Underflow in products loses
    // far less: `all` is above kMinValue.
    constexpr double kError = 0x1p-92, kMinValue = 0x1p-600, kMaxValue = 0x1p1000;
    if (!(all > kMinValue && all < kMaxValue)) return 0;
    const double error = kError * all;
    return det.high > error ? 1 : det.high < -error ? -1 : 0;
}

/// Runs work() isolated from the parallel loop around it: if that loop ends by an exception, loops
/// within work() continue. Returns after work() has returned.
/// \throws exceptions of work()
void runUncancelled(const std::function<void()>& work);

/// Returns the value of work(), for values that outlive the parallel loop in which they are first
/// requested. Once a task of that loop throws, oneTBB silently skips all loops within its other
/// tasks, which would store incomplete values. Loops within work() run to their end.
///
///     const auto boxes = uncancelled([&] { return boundsOfEach(polygons); });
/// \throws exceptions of work()
template <typename Work>
auto uncancelled(Work work) {
    std::optional<decltype(work())> value;
    runUncancelled([&] { value.emplace(work()); });
    return *std::move(value);
}

}  // namespace ispace
