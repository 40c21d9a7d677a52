// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/robot_sensors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/collision.h"

namespace ispace {

namespace {

constexpr int kCircles = 3, kInFirst = 6;
static_assert(kSonarRays == 1 + kInFirst * (1 + 2 + 3));
/// Of the body's height.
constexpr double kSonarHeight = 0.75;
/// What is lower is the floor.
constexpr double kFloor = 1e-3;

/// Unit vectors within a cone about the heading.
Directions coneOf(Angle heading, Angle fov) {
    const Frame3 frame(Pose3{{}, heading, {}, {}});
    Directions rays;
    rays.resize(kSonarRays);
    rays.set(0, frame.forward);
    std::size_t next = 1;
    for (int circle = 1; circle <= kCircles; ++circle) {
        const Angle off = (0.5 * circle / kCircles) * fov;
        const int count = kInFirst * circle;
        for (int k = 0; k < count; ++k) {
            const double around = 2 * std::numbers::pi * k / count;
            rays.set(next++, frame * Vec3{cos(off), sin(off) * std::cos(around),
                                          sin(off) * std::sin(around)});
        }
    }
    return rays;
}

}  // namespace

std::vector<float> sonarRanges(const RobotModel& model, const Pose2& pose,
                               const RayWorld& environment, const MovingBodies& bodies,
                               std::uint32_t own) {
    const SonarRing& ring = model.sonar;
    std::vector<float> ranges;
    std::vector<float> cone(kSonarRays);
    for (const Pose2& place : ring.places) {
        const Point2 at = pose * place.position;
        const Point3 origin{at.x, at.y, kSonarHeight * model.height};
        const Directions rays = coneOf(pose.heading + place.heading, ring.fov);
        environment.cast(origin, rays, ring.max_range, cone);
        for (std::size_t i = 0; i < kSonarRays; ++i)
            if (origin.z + static_cast<double>(cone[i]) * rays.z[i] < kFloor)
                cone[i] = std::numeric_limits<float>::infinity();
        bodies.shorten(origin, rays, ring.max_range, own, cone);
        const float nearest = *std::min_element(cone.begin(), cone.end());
        ranges.push_back(std::max(nearest, static_cast<float>(ring.min_range)));
    }
    return ranges;
}

std::vector<bool> pressedBumpers(
    const RobotModel& model, const Pose2& pose, Vec2 bump,
    const std::function<double(Point2 place, double farthest)>& nearest) {
    constexpr double kStep = 0.25;  // degrees
    // Between two places on the rim, and what rounding leaves.
    const double slack = 0.5 * kStep * std::numbers::pi / 180 * model.radius + 2 * kTouch;
    std::vector<bool> pressed;
    for (const Bumper& bumper : model.bumpers) {
        const double from = bumper.from.degrees(), to = bumper.to.degrees();
        const int places = std::max(1, static_cast<int>(std::ceil((to - from) / kStep)));
        bool hit = false;
        for (int k = 0; k <= places && !hit; ++k) {
            const Angle bearing = Angle::degrees(from + (to - from) * k / places);
            const Vec2 outwards = unitVector(pose.heading + bearing);
            const double way = dot(outwards, bump);
            hit = way > 0 &&
                  nearest(pose.position + model.radius * outwards, way + slack) < way + slack;
        }
        pressed.push_back(hit);
    }
    return pressed;
}

}  // namespace ispace
