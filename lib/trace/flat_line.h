// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "base/simd.h"
#include "trace/flat_tree.h"

namespace ispace {

// What decides about rays and lines, in plain doubles and in one place: fans and single rays
// compute with it in the same order, so that they agree to the last bit. All is relative to the
// origin, and nearness is one over distance: the nearest is the largest, and no line costs a
// division a beam.

/// Before a loop over lanes: it becomes vectors, which it cannot once it is unrolled.
#define ISPACE_LANES _Pragma("GCC unroll 1")

/// A line whose straight continuation passes this near to the origin is seen from its edge; a ray
/// that passes an end of a line this near meets it. More than coordinates of a town round by.
constexpr double kFlatEdge = 1e-9;
/// No ray meets an end farther aside than this times the distance of the line's straight
/// continuation: of a line seen almost from its edge it would meet that far before or behind the
/// end. So it is never more of the turn, in radians.
constexpr double kFlatEdgeAngle = 1e-6;
/// Least |cosine| between lines of one direction.
constexpr double kFlatParallel = 1 - 1e-6;

ISPACE_INLINE double flatLess(double a, double b) { return a < b ? a : b; }
ISPACE_INLINE double flatMore(double a, double b) { return a > b ? a : b; }
/// One of two, both computed. Of a plain choice the compiler makes a branch around what traps, as
/// it says of all arithmetic, and then no vectors.
ISPACE_INLINE double flatChoice(bool first, double a, double b) {
    const std::uint64_t mask = first ? ~std::uint64_t{0} : 0;
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(a) & mask) |
                                 (std::bit_cast<std::uint64_t>(b) & ~mask));
}

/// A lower bound of the distance to a box, 0 if the origin is in it: the octagon about the origin
/// that touches the box, at most 8 % too near. A box within another is never nearer, roundings
/// included, so that leaving out boxes changes nothing.
ISPACE_INLINE double distanceOf(double left, double right, double low, double high) {
    constexpr double kDiagonal = 0.70710678;
    const double x = flatMore(flatMore(left, -right), 0.0);
    const double y = flatMore(flatMore(low, -high), 0.0);
    return flatMore(flatMore(x, y), kDiagonal * (x + y));
}

/// A line as seen from an origin.
struct FlatLine {
    double ax, ay, bx, by;  ///< its ends, counter-clockwise about the origin
    double ux, uy;          ///< from a to b, times the nearness of the line at a unit angle
    double nearest;         ///< upper bound of its nearness
    double height;          ///< distance of its straight continuation
    double edge;            ///< how near to an end a ray meets it
    bool stops;             ///< not seen from its edge
};

ISPACE_INLINE FlatLine lineFrom(const FlatTree::Leaf& leaf, int i, double ox, double oy) {
    const double px = leaf.ax[i] - ox, py = leaf.ay[i] - oy;
    const double qx = leaf.bx[i] - ox, qy = leaf.by[i] - oy;
    const double ex = leaf.bx[i] - leaf.ax[i], ey = leaf.by[i] - leaf.ay[i];
    const double area = px * ey - py * ex;
    const double size = std::fabs(area), over = 1 / area;
    const bool turned = area < 0;
    FlatLine line;
    line.ax = turned ? qx : px;
    line.ay = turned ? qy : py;
    line.bx = turned ? px : qx;
    line.by = turned ? py : qy;
    line.ux = ex * over;
    line.uy = ey * over;
    line.nearest =
        1 / distanceOf(flatLess(px, qx), flatMore(px, qx), flatLess(py, qy), flatMore(py, qy));
    line.height = size / leaf.length[i];
    line.edge = flatLess(kFlatEdge, kFlatEdgeAngle * line.height);
    line.stops = size > kFlatEdge * leaf.length[i];
    return line;
}

/// Nearness of the place where a ray along (x, y) meets the closed line; not positive if it does
/// not.
ISPACE_INLINE double nearnessAlong(const FlatLine& line, double x, double y) {
    const double from_a = line.ax * y - line.ay * x, to_b = x * line.by - y * line.bx;
    const double steep = x * line.uy - y * line.ux;
    const bool is_between = (from_a >= -line.edge) & (to_b >= -line.edge);
    return flatChoice(is_between, flatLess(steep, line.nearest), 0.0);
}

}  // namespace ispace
