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

struct Disc {
    Point2 place;
    double radius;
};

/// Finds who stands in whom: of robots those before them in the scene, and people.
class Neighbours {
  public:
    Neighbours(std::span<const PlacedRobot> robots, std::span<const Person> people)
        : robots_(robots.size()) {
        double reach = 0;
        std::vector<Point2> places;
        const auto add = [&](Point2 place, double radius) {
            discs_.push_back({place, radius});
            places.push_back(place);
            reach = std::max(reach, radius);
        };
        for (const PlacedRobot& robot : robots) add(robot.pose.position, robot.model.radius);
        for (const Person& person : people) add(person.place, person.radius);
        grid_.rebuild(places, reach);
    }

    /// The first robot that robot `i` stands in.
    [[nodiscard]] std::optional<std::size_t> robotBefore(std::size_t i) const {
        return firstOver(i, 0, i);
    }
    /// The first person, counted behind the robots.
    [[nodiscard]] std::optional<std::size_t> person(std::size_t i) const {
        return firstOver(i, robots_, discs_.size());
    }
    [[nodiscard]] double apart(std::size_t i, std::size_t j) const {
        return distance(discs_[i].place, discs_[j].place);
    }

  private:
    [[nodiscard]] std::optional<std::size_t> firstOver(std::size_t i, std::size_t begin,
                                                       std::size_t end) const {
        const auto& [place, radius] = discs_[i];
        const Vec2 margin{radius, radius};
        std::size_t first = end;
        grid_.forEachNear({place - margin, place + margin}, [&](std::size_t other) {
            if (other >= begin && other < first &&
                apart(i, other) < discs_[i].radius + discs_[other].radius - kTouch)
                first = other;
        });
        return first < end ? std::optional(first) : std::nullopt;
    }

    std::size_t robots_;
    std::vector<Disc> discs_;
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

void checkStart(const Scene& scene, std::span<const Person> people, const ObstacleSets& obstacles) {
    Diagnostics findings;
    const Neighbours neighbours(scene.robots, people);
    const auto distance_text = [&](std::size_t i, std::size_t other) {
        return "overlap: their centres are " + formatFixed(neighbours.apart(i, other), 3) +
               " m apart, less than their radii together";
    };
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
        if (const auto other = neighbours.robotBefore(i))
            findings.add(robot.place.finding("robots " + scene.robots[*other].id + " and " +
                                             robot.id + ' ' + distance_text(i, *other)));
        if (const auto other = neighbours.person(i))
            findings.add(robot.place.finding(name + " and human " +
                                             std::string(people[*other - scene.robots.size()].id) +
                                             ' ' + distance_text(i, *other)));
    }
    findings.throwIfAny();
}

}  // namespace ispace
