// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "scene/bodies.h"

namespace ispace::testing {

namespace {

double distanceTo(const Segment2& line, Point2 p) {
    const Vec2 along = line.b - line.a;
    const double square = dot(along, along);
    const double t = square > 0 ? std::clamp(dot(p - line.a, along) / square, 0.0, 1.0) : 0;
    return distance(p, line.a + t * along);
}

bool isClear(const Slice& band, Point2 p, double radius) {
    bool clear = true;
    band.forEachLine([&](const Segment2& line) { clear &= distanceTo(line, p) > radius; });
    return clear && std::none_of(band.solids.begin(), band.solids.end(), [p](const Polygon& solid) {
               return locate(solid, p) != Side::Outside;
           });
}

/// Nearest reading within a part of the beams.
float nearest(const Scan& scan, double from, double to) {
    const auto count = static_cast<double>(scan.ranges.size());
    const auto begin = scan.ranges.begin() + static_cast<std::ptrdiff_t>(from * count);
    const auto end = scan.ranges.begin() + static_cast<std::ptrdiff_t>(to * count);
    return *std::min_element(begin, end);
}

struct Disc {
    Point2 place;
    double radius;
};

struct Wanted {
    const Environment* environment;
    double height, radius, gap;
};

/// Free points drawn from a seed, at a distance from earlier ones.
std::vector<Pose2> places(const Wanted& wanted, std::vector<Disc> taken, std::size_t count,
                          std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const Environment& environment = *wanted.environment;
    const Slice band = environment.band(0, wanted.height);
    const Box2 box = bounds(environment.indoor());
    std::uniform_real_distribution<double> x(box.low.x, box.high.x), y(box.low.y, box.high.y);
    std::uniform_real_distribution<double> heading(-180, 180);
    std::vector<Pose2> found;
    for (std::size_t tries = 0; found.size() < count && tries < 1000 * count; ++tries) {
        const Point2 p{x(random), y(random)};
        const Angle faces = Angle::degrees(heading(random));
        const bool apart = std::none_of(taken.begin(), taken.end(), [&](const Disc& disc) {
            return distance(disc.place, p) < disc.radius + wanted.radius + wanted.gap;
        });
        if (!apart || environment.indoor().locate(p) != Side::Inside ||
            !isClear(band, p, wanted.radius + wanted.gap))
            continue;
        taken.push_back({p, wanted.radius});
        found.push_back({p, faces});
    }
    return found;
}

}  // namespace

std::vector<PlacedRobot> crowd(const Environment& environment, const RobotModel& model,
                               std::size_t count, double gap, std::uint64_t seed) {
    std::vector<PlacedRobot> robots;
    for (const Pose2& pose :
         places({&environment, model.height, model.radius, gap}, {}, count, seed))
        robots.push_back({"r" + std::to_string(robots.size() + 1), model, pose, {}});
    return robots;
}

void addPeople(Scene& scene, std::size_t count, double gap, std::uint64_t seed) {
    const PlacedPerson person;
    std::vector<Disc> taken;
    for (const PlacedRobot& robot : scene.robots)
        taken.push_back({robot.pose.position, robot.model.radius});
    for (const Pose2& pose :
         places({&scene.environment, person.height, humanRadius(person.height), gap},
                std::move(taken), count, seed)) {
        scene.people.push_back(person);
        scene.people.back().id = "h" + std::to_string(scene.people.size());
        scene.people.back().pose = pose;
    }
}

void mountLasers(Scene& scene, const Laser& laser) {
    for (std::size_t i = 0; i < scene.robots.size(); ++i) {
        const Pose3 mount{{0, 0, kScanHeight}, {}, {}, {}};
        scene.sensors.push_back({"l" + std::to_string(i + 1), laser,
                                 mountedPose(scene.robots[i].pose, mount), Mount{i, mount}});
    }
}

void wander(World& world) {
    constexpr float kNear = 0.8F;
    for (const std::size_t i : world.latestReadings()) {
        const Scan& scan = world.reading(i).scan();
        const bool is_free = nearest(scan, 0.3, 0.7) > kNear && nearest(scan, 0.1, 0.9) > kNear / 2;
        const bool left = nearest(scan, 0.5, 0.8) > nearest(scan, 0.2, 0.5);
        world.command(i, {Verb::Speed, is_free ? 0.5 : 0.0});
        world.command(i, {Verb::Rotspeed, is_free ? 0.0 : left ? 60.0 : -60.0});
    }
}

void stumble(World& world, std::uint64_t seed) {
    // Each robot thinks again every half second, not all at the same step.
    const auto step = static_cast<std::uint64_t>(world.steps());
    for (std::size_t i = 0; i < world.movers().size(); ++i) {
        if ((step + 7 * i) % 100 != 0 || world.movers()[i].course != MotionPlan()) continue;
        std::mt19937_64 random(seed ^ (step << 20U) ^ i);
        const RobotModel& model = world.movers()[i].model;
        const double range = std::uniform_real_distribution<double>(-1, 1)(random);
        const double turn = std::uniform_real_distribution<double>(-1, 1)(random);
        world.command(i, {Verb::Speed, range * model.max_speed});
        world.command(i, {Verb::Rotspeed, turn * model.max_rotspeed.degrees()});
    }
}

}  // namespace ispace::testing
