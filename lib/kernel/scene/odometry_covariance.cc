// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/odometry_covariance.h"

#include <cmath>
#include <cstddef>

namespace ispace {

MotionAlphas alphasOf(const MotionNoise& noise) {
    MotionAlphas sums{};
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = noise.motion[i] + noise.odometry[i];
    return sums;
}

PoseCovariance covarianceOf(const Pose2& motion, const MotionAlphas& alphas) {
    const Vec2 way = motion.position - Point2{};
    const double metres = length(way), turn = std::abs(motion.heading.radians());
    const double of_turn = alphas[0] * turn + alphas[1] * metres;
    const double of_way = alphas[2] * metres + alphas[3] * turn;
    const Vec2 along = metres > 0 ? (1 / metres) * way : unitVector(motion.heading);
    // Half of the error of the turn comes before the way.
    const Vec2 aside = 0.5 * perpendicular(way);
    return {.xx = of_way * along.x * along.x + of_turn * aside.x * aside.x,
            .xy = of_way * along.x * along.y + of_turn * aside.x * aside.y,
            .yy = of_way * along.y * along.y + of_turn * aside.y * aside.y,
            .xh = of_turn * aside.x,
            .yh = of_turn * aside.y,
            .hh = of_turn};
}

PoseCovariance propagated(const PoseCovariance& before, Angle heading, const Pose2& motion,
                          const PoseCovariance& step) {
    const auto [c, s] = cosSin(heading);
    const Vec2 way = motion.position - Point2{};
    // An error of the heading turns the way: to the left, by its length.
    const Vec2 aside{-(s * way.x + c * way.y), c * way.x - s * way.y};
    const PoseCovariance& p = before;
    return {.xx = p.xx + 2 * aside.x * p.xh + aside.x * aside.x * p.hh + c * c * step.xx -
                  2 * c * s * step.xy + s * s * step.yy,
            .xy = p.xy + aside.y * p.xh + aside.x * p.yh + aside.x * aside.y * p.hh +
                  c * s * (step.xx - step.yy) + (c * c - s * s) * step.xy,
            .yy = p.yy + 2 * aside.y * p.yh + aside.y * aside.y * p.hh + s * s * step.xx +
                  2 * c * s * step.xy + c * c * step.yy,
            .xh = p.xh + aside.x * p.hh + c * step.xh - s * step.yh,
            .yh = p.yh + aside.y * p.hh + s * step.xh + c * step.yh,
            .hh = p.hh + step.hh};
}

PoseCovariance twistCovariance(Vec2 velocity, Angle rate, const MotionAlphas& alphas,
                               double seconds) {
    const PoseCovariance all =
        covarianceOf({Point2{} + seconds * velocity, seconds * rate}, alphas);
    const double share = 1 / (seconds * seconds);
    return {.xx = share * all.xx,
            .xy = share * all.xy,
            .yy = share * all.yy,
            .xh = share * all.xh,
            .yh = share * all.yh,
            .hh = share * all.hh};
}

}  // namespace ispace
