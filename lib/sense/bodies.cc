// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/bodies.h"

#include "layout/bodies.h"

namespace ispace {

MovingBody robotBody(const RobotModel& model, const Pose2& pose, std::uint32_t owner) {
    MovingBody body;
    body.pose = {pose * Point2{model.center, 0}, pose.heading};
    if (model.length > 0) {
        body.half_length = model.length / 2;
        body.half_width = model.width / 2;
    } else {
        body.radius = model.radius;
    }
    body.top = model.height;
    body.owner = owner;
    return body;
}

std::vector<MovingBody> humanBodies(double height, const Pose2& pose, std::uint32_t owner) {
    std::vector<MovingBody> bodies;
    for (const Upright& part : humanUprights(height))
        bodies.push_back({.pose = {pose * part.center, pose.heading},
                          .half_length = part.half_length,
                          .half_width = part.half_width,
                          .radius = part.radius,
                          .bottom = part.bottom,
                          .top = part.top,
                          .owner = owner});
    return bodies;
}

std::vector<MovingBody> bodiesOf(const Scene& scene) {
    std::vector<MovingBody> bodies;
    bodies.reserve(scene.robots.size());
    for (const PlacedRobot& robot : scene.robots)
        bodies.push_back(
            robotBody(robot.model, robot.pose, static_cast<std::uint32_t>(bodies.size())));
    // Nobody's: no sensor rides on a person.
    const auto owner = static_cast<std::uint32_t>(bodies.size());
    for (const Placed& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        if (record.keyword() != "human") continue;
        const Pose2 pose{placed.pose.position.onFloor(), placed.pose.heading};
        const std::vector<MovingBody> parts = humanBodies(record.number("height"), pose, owner);
        bodies.insert(bodies.end(), parts.begin(), parts.end());
    }
    return bodies;
}

}  // namespace ispace
