// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/round_view.h"

#include <cmath>
#include <cstdint>

#include "base/simd.h"
#include "trace/flat_kernels.h"

namespace ispace {

namespace {

/// Values of a body and the rays' origin, as in meetRound() in triangle_set.cc.
struct RoundTask {
    Ellipse curve;
    Vec2 q;
    double c, low_end, high_end;
};

// Omits branches of TriangleSet::meetRound() that matter only for upright or level rays.
ISPACE_SIMD_CLONES bool meetAll(const RoundTask& task, const RayPacket& packet, float* out) {
    const Vec2 axis = task.curve.axis, q = task.q;
    const double wide = task.curve.half_length, deep = task.curve.half_width;
    const double c = task.c, low_end = task.low_end, high_end = task.high_end;
    std::int64_t special = 0;
    alignas(64) std::array<float, kLanes> multiples;  // NOLINT: set in the loop
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double x = packet.x[lane], y = packet.y[lane], rise = packet.z[lane];
        const double dx = (axis.x * x + axis.y * y) / wide, dy = (axis.x * y - axis.y * x) / deep;
        const double a = dx * dx + dy * dy, b = q.x * dx + q.y * dy;
        special |= (a > 0 ? 0 : 1) | (rise != 0 ? 0 : 1);
        const double side = q.x * dy - q.y * dx;
        const double root = std::sqrt(a - side * side);  // NaN if the ray misses
        const bool nears = b > 0;
        const double right = -b - root, left = root - b, far = flatChoice(nears, right, left);
        const double one = far / a, two = c / far;
        const double from = flatChoice(nears, one, two), to = flatChoice(nears, two, one);
        const double s = low_end / rise, t = high_end / rise;
        const double low = flatMin(t, s), high = flatMax(t, s);
        const double enter = flatMax(low, from), leave = flatMin(high, to);
        const double multiple = flatChoice(enter >= 0, enter, leave);
        const bool is_met = (enter <= leave) & (leave >= 0) & (multiple <= packet.reach[lane]);
        multiples[lane] = simd::choose(is_met, static_cast<float>(multiple), kNoReturn);
    }
    if (special != 0) return false;
    for (std::size_t lane = 0; lane < kLanes; ++lane) out[lane] = multiples[lane];
    return true;
}

}  // namespace

RoundView::RoundView(const RoundBody& body, Point3 origin, double ray_epsilon)
    : body_(&body),
      is_far_(body.isFarOutside(body.curve.toUnit(origin.onFloor() - body.curve.center), origin.z,
                                ray_epsilon)) {}

bool RoundView::meet(const RayPacket& packet, std::array<float, kLanes>& multiples) const {
    if (!is_far_) return false;
    const Point3 origin{packet.origin_x[0], packet.origin_y[0], packet.origin_z[0]};
    const Vec2 q = body_->curve.toUnit(origin.onFloor() - body_->curve.center);
    const RoundTask task{body_->curve, q, dot(q, q) - 1, body_->bottom - origin.z,
                         body_->top - origin.z};
    return meetAll(task, packet, multiples.data());
}

}  // namespace ispace
