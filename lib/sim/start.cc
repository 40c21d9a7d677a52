// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/start.h"

#include <algorithm>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/number.h"
#include "trace/moving_bodies.h"

namespace ispace {

namespace {

double apart(const PlacedRobot& a, const PlacedRobot& b) {
    return distance(a.pose.position, b.pose.position);
}

/// Finds robots that stand in others before them in the scene.
class Neighbours {
  public:
    explicit Neighbours(std::span<const PlacedRobot> robots) : robots_(robots) {
        double reach = 0;
        std::vector<Point2> places;
        places.reserve(robots.size());
        for (const PlacedRobot& robot : robots) {
            places.push_back(robot.pose.position);
            reach = std::max(reach, robot.model.radius);
        }
        grid_.rebuild(places, reach);
    }

    /// The first one that robot `i` stands in.
    [[nodiscard]] std::optional<std::size_t> before(std::size_t i) const {
        const Point2 place = robots_[i].pose.position;
        const double radius = robots_[i].model.radius;
        const Vec2 margin{radius, radius};
        std::size_t first = i;
        grid_.forEachNear({place - margin, place + margin}, [&](std::size_t other) {
            const PlacedRobot& robot = robots_[other];
            if (other < first &&
                distance(place, robot.pose.position) < radius + robot.model.radius - kTouch)
                first = other;
        });
        return first < i ? std::optional(first) : std::nullopt;
    }

  private:
    std::span<const PlacedRobot> robots_;
    FloorGrid grid_;
};

}  // namespace

ObstacleSets obstaclesOf(const Scene& scene) {
    ObstacleSets sets;
    for (const PlacedRobot& robot : scene.robots) {
        const double height = robot.model.height;
        if (!sets.contains(height))
            sets.emplace(height, Obstacles(scene.environment.band(0, height)));
    }
    return sets;
}

void checkStart(const Scene& scene, const ObstacleSets& obstacles) {
    Diagnostics findings;
    const Neighbours neighbours(scene.robots);
    // Full findings end it: robots on one heap would be looked at in pairs.
    for (std::size_t i = 0; i < scene.robots.size() && !findings.full(); ++i) {
        const PlacedRobot& robot = scene.robots[i];
        const std::string name = "robot " + robot.id;
        const Obstacles& things = obstacles.at(robot.model.height);
        if (const auto element = things.overlap(robot.pose.position, robot.model.radius)) {
            findings.add(robot.place.finding(
                name + " stands in " + scene.environment.elements()[*element].id +
                " (its radius is " + formatDouble(robot.model.radius) + " m)"));
        }
        if (const auto other = neighbours.before(i)) {
            findings.add(robot.place.finding("robots " + scene.robots[*other].id + " and " +
                                             robot.id + " overlap: their centres are " +
                                             formatFixed(apart(robot, scene.robots[*other]), 3) +
                                             " m apart, less than their radii together"));
        }
    }
    findings.throwIfAny();
}

}  // namespace ispace
