// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/body_pencil.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/simd.h"
#include "trace/flat_kernels.h"

namespace ispace {

namespace {

constexpr int kLanes = static_cast<int>(BodyTable::kLanes);

/// Not of extreme numbers.
double lengthOf(Vec2 v) { return std::sqrt(dot(v, v)); }

/// Bodies one after the other: the circle about their level cuts at the rays' heights, how near
/// that is to the rays at least, and whether a ray may meet it.
struct alignas(64) Met {
    double x[BodyTable::kLanes], y[BodyTable::kLanes], radius[BodyTable::kLanes];
    double nearest[BodyTable::kLanes], may_meet[BodyTable::kLanes];
};

template <bool kLeans>
ISPACE_INLINE void lookAt(const BodyTable& table, std::size_t begin, const BodyPencil::Hull& hull,
                          Met& met) {
    const double* const x = table.x.data() + begin;
    const double* const y = table.y.data() + begin;
    const double* const reach = table.reach.data() + begin;
    const double* const bottom = table.bottom.data() + begin;
    const double* const top = table.top.data() + begin;
    const double* const lean_x = kLeans ? table.lean_x.data() + begin : nullptr;
    const double* const lean_y = kLeans ? table.lean_y.data() + begin : nullptr;
    const double no_sides = hull.is_cone ? 0.0 : std::numeric_limits<double>::infinity();
    for (int i = 0; i < kLanes; ++i) {
        met.x[i] = x[i];
        met.y[i] = y[i];
        met.radius[i] = reach[i];
        if (kLeans) {
            const double low = flatMax(bottom[i], hull.low), high = flatMin(top[i], hull.high);
            const double middle = 0.5 * (low + high);
            met.x[i] += lean_x[i] * middle;
            met.y[i] += lean_y[i] * middle;
            const double lean = std::fabs(lean_x[i]) + std::fabs(lean_y[i]);
            met.radius[i] += 0.5 * lean * flatMax(high - low, 0.0);
        }
        const double wx = met.x[i] - hull.x, wy = met.y[i] - hull.y;
        const double distance = std::sqrt(wx * wx + wy * wy);
        const double around = met.radius[i] + hull.spread;
        const double slack = around + kFarSlack * (around + distance) + no_sides;
        met.nearest[i] = distance - around;
        const bool meets = (hull.right_x * wy - hull.right_y * wx >= -slack) &
                           (hull.left_x * wy - hull.left_y * wx <= slack) &
                           (met.nearest[i] <= hull.far) & (bottom[i] <= hull.high) &
                           (top[i] >= hull.low);
        met.may_meet[i] = meets ? 1.0 : 0.0;
    }
}

ISPACE_SIMD_CLONES
void lookAtUpright(const BodyTable& table, std::size_t begin, const BodyPencil::Hull& hull,
                   Met& met) {
    lookAt<false>(table, begin, hull, met);
}

ISPACE_SIMD_CLONES
void lookAtLeaning(const BodyTable& table, std::size_t begin, const BodyPencil::Hull& hull,
                   Met& met) {
    lookAt<true>(table, begin, hull, met);
}

}  // namespace

BodyPencil::BodyPencil(std::span<const Point3> origins, const Directions& directions,
                       std::size_t begin, std::size_t end, double max_range,
                       const ShortenedRanges& ranges)
    : origins_(origins), directions_(directions), begin_(begin), end_(end), ranges_(ranges) {
    const double most = max_range * (1 + kFarSlack);
    hull_.low = std::numeric_limits<double>::infinity();
    hull_.high = -hull_.low;
    Box2 circle;
    for (std::size_t k = begin; k < end; ++k) {
        const double far =
            std::min(static_cast<double>(ranges_[k]) * (1 + kFarSlack) + kFarSlack, most);
        const Point3 from = origins[k];
        const double rise = from.z + far * directions.z[k];
        hull_.far = std::max(hull_.far, far);
        hull_.low = std::min({hull_.low, from.z, rise});
        hull_.high = std::max({hull_.high, from.z, rise});
        circle.add(from.onFloor());
        box_.add(from.onFloor() + far * Vec2{directions.x[k], directions.y[k]});
    }
    box_.add(circle.low);
    box_.add(circle.high);
    const Point2 middle = circle.center();
    hull_.x = middle.x;
    hull_.y = middle.y;
    hull_.spread = 0.5 * lengthOf({circle.width(), circle.depth()});
    setSides();
}

void BodyPencil::setSides() {
    Vec2 ahead;
    for (std::size_t k = begin_; k < end_; ++k)
        ahead = ahead + Vec2{directions_.x[k], directions_.y[k]};
    Vec2 right = ahead, left = ahead;
    bool is_cone = true;
    for (std::size_t k = begin_; k < end_; ++k) {
        const Vec2 flat{directions_.x[k], directions_.y[k]};
        const double along = dot(ahead, flat), aside = cross(ahead, flat);
        // Within some 84 degrees: upright rays point nowhere.
        is_cone = is_cone && along > 0.1 * std::fabs(aside) && along > 0;
        if (cross(right, flat) < 0) right = flat;
        if (cross(left, flat) > 0) left = flat;
    }
    hull_.is_cone = is_cone;
    if (!is_cone) return;
    const double to_right = 1 / lengthOf(right), to_left = 1 / lengthOf(left);
    hull_.right_x = to_right * right.x;
    hull_.right_y = to_right * right.y;
    hull_.left_x = to_left * left.x;
    hull_.left_y = to_left * left.y;
}

void BodyPencil::meet(const BodyTable& table, std::size_t begin, std::size_t end, std::uint32_t own,
                      std::span<const MovingBody> bodies, std::span<const BodyExtent> extents) {
    Met met;
    for (std::size_t i = begin; i < end; i += BodyTable::kLanes) {
        (table.lean_x.empty() ? lookAtUpright : lookAtLeaning)(table, i, hull_, met);
        for (std::size_t k = 0; k < std::min(BodyTable::kLanes, end - i); ++k) {
            if (met.may_meet[k] == 0) continue;
            const std::uint32_t body = table.index[i + k];
            if (bodies[body].owner != own)
                meetBody({bodies[body],
                          extents[body].axes,
                          {met.x[k], met.y[k]},
                          met.radius[k],
                          met.nearest[k]});
        }
    }
}

void BodyPencil::meetBody(const Ahead& ahead) {
    const double near = ahead.radius + kFarSlack * (ahead.radius + hull_.far);
    for (std::size_t k = begin_; k < end_; ++k) {
        if (static_cast<double>(ranges_[k]) <= ahead.nearest) continue;
        // Most rays pass by the circle about it: flat directions are at most 1 long.
        const Vec2 flat{directions_.x[k], directions_.y[k]};
        if (std::fabs(cross(ahead.center - origins_[k].onFloor(), flat)) > near) continue;
        const BodyFrom from(ahead.body, ahead.axes, origins_[k]);
        ranges_.shorten(k, from.meet(directions_[k]), 1);
    }
}

}  // namespace ispace
