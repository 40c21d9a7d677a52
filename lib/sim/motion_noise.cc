// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/motion_noise.h"

#include <algorithm>
#include <cmath>

namespace ispace {

namespace {

/// Two independent standard normal numbers.
std::array<double, 2> normals(const RandomKey& key) {
    float a = 0, b = 0;
    draw(key, 0, {.normal = std::span(&a, 1), .other = std::span(&b, 1)});
    return {static_cast<double>(a), static_cast<double>(b)};
}

}  // namespace

Pose2 relativePose(const Pose2& from, const Pose2& to) {
    const Vec2 way = to.position - from.position;
    const Vec2 ahead = unitVector(from.heading);
    return {{dot(way, ahead), cross(ahead, way)}, wrapped(to.heading - from.heading)};
}

Pose2 composed(const Pose2& outer, const Pose2& inner) {
    return {outer * inner.position, wrapped(outer.heading + inner.heading)};
}

Pose2 strayed(const Pose2& motion, const std::array<double, 4>& alphas, const RandomKey& key) {
    const Vec2 way = motion.position - Point2{};
    const double metres = length(way), turn = std::abs(motion.heading.radians());
    if (metres == 0 && turn == 0) return motion;
    const auto [of_turn, of_way] = normals(key);
    const Angle error = Angle::radians(of_turn * std::sqrt(alphas[0] * turn + alphas[1] * metres));
    const double stretch = of_way * std::sqrt(alphas[2] * metres + alphas[3] * turn);
    // Who turns on the spot strays along the new heading.
    const Vec2 along = metres > 0 ? (1 / metres) * way : unitVector(motion.heading);
    const Vec2 far = (metres + stretch) * along;
    const Vec2 half = unitVector(0.5 * error);
    return {Point2{} + (far.x * half + far.y * perpendicular(half)), motion.heading + error};
}

bool strays(const std::array<double, 4>& alphas) {
    return std::any_of(alphas.begin(), alphas.end(), [](double alpha) { return alpha != 0; });
}

std::vector<std::size_t> strayStarts(std::span<Mover> movers, const ObstacleSets& obstacles,
                                     std::uint64_t seed) {
    constexpr std::uint64_t kTries = 100;
    const auto is_free = [&](std::size_t i, const Pose2& pose) {
        const RobotModel& model = movers[i].model;
        // Nor through a wall.
        const Segment2 way{movers[i].pose.position, pose.position};
        if (obstacles.at(model.height).stop(way, model.radius)) return false;
        for (std::size_t j = 0; j < movers.size(); ++j)
            if (j != i && distance(pose.position, movers[j].pose.position) <
                              model.radius + movers[j].model.radius)
                return false;
        return true;
    };
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const MotionNoise& noise = movers[i].model.noise;
        if (noise.start_place == 0 && noise.start_heading == Angle()) continue;
        const std::uint64_t id = hashOf(movers[i].id);
        bool found = false;
        for (std::uint64_t k = 0; k < kTries && !found; ++k) {
            const auto [dx, dy] = normals({seed, Purpose::Start, id, 2 * k});
            const auto [turn, unused] = normals({seed, Purpose::Start, id, 2 * k + 1});
            const Pose2 pose{movers[i].pose.position + noise.start_place * Vec2{dx, dy},
                             wrapped(movers[i].pose.heading + turn * noise.start_heading)};
            found = is_free(i, pose);
            if (found) movers[i].pose = pose;
        }
        if (!found) kept.push_back(i);
    }
    return kept;
}

Odometer::Odometer(const Mover& mover, std::uint64_t seed, bool noise)
    : noise_(mover.model.noise),
      seed_(seed),
      id_(hashOf(mover.id)),
      counts_(noise && (strays(noise_.motion) || strays(noise_.odometry))),
      drifts_(noise && strays(noise_.motion)),
      origin_(mover.pose) {}

Vec2 Odometer::stray(Motion& end, const Pose2& start, std::int64_t step) {
    turned_ = relativePose(start, end.pose);
    if (!drifts_) return {};
    const Pose2 motion = strayed(turned_, noise_.motion,
                                 {seed_, Purpose::Motion, id_, static_cast<std::uint64_t>(step)});
    const Pose2 pose = composed(start, motion);
    const Vec2 drift = pose.position - end.pose.position;
    end.turn_end = wrapped(end.turn_end + (pose.heading - end.pose.heading));
    end.pose = pose;
    return drift;
}

void Odometer::count(std::int64_t step) {
    if (!counts_) return;
    pose_ =
        composed(pose_, strayed(turned_, noise_.odometry,
                                {seed_, Purpose::Odometry, id_, static_cast<std::uint64_t>(step)}));
    turned_ = {};
}

}  // namespace ispace
