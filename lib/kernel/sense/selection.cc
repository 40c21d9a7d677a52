// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/selection.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/glob.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace {

bool isSelected(const std::string& id, const std::vector<std::string>& globs) {
    return globs.empty() || std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
               return Glob(glob).matches(id);
           });
}

std::vector<std::size_t> sensorRecords(const Scene& scene, std::span<const std::string_view> kinds,
                                       const std::vector<std::string>& globs) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (std::find(kinds.begin(), kinds.end(), scene.records[i].keyword()) != kinds.end() &&
            isSelected(scene.ids[i], globs))
            found.push_back(i);
    return found;
}

double wholeNanoseconds(double seconds) {
    constexpr double kNano = 1e9, kMax = 9e6;  // doubles are exact for integers up to 9e15
    return std::fabs(seconds) < kMax ? std::round(seconds * kNano) / kNano : seconds;
}

std::uint32_t carrierOf(const Sensor& sensor) {
    if (sensor.mount) return static_cast<std::uint32_t>(sensor.mount->robot);
    if (sensor.person) return kFirstPerson + static_cast<std::uint32_t>(*sensor.person);
    return MovingBodies::kNoOwner;
}

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

bool isAtSome(const MovingBody& body, std::span<const double> heights) {
    return heights.empty() || std::any_of(heights.begin(), heights.end(), [&body](double z) {
               return body.bottom <= z && z <= body.top;
           });
}

void addHumanBodies(double height, const Pose2& pose, std::uint32_t owner, Angle swing,
                    std::span<const double> heights, std::vector<MovingBody>& bodies,
                    const PersonFigure* figure) {
    const CosSin axes = cosSin(pose.heading);
    for (const BodyPart& part : personParts(height, figure, swing)) {
        const MovingBody body = movingBody(part, pose, axes, owner);
        if (isAtSome(body, heights)) bodies.push_back(body);
    }
}

std::vector<MovingBody> humanBodies(double height, const Pose2& pose, std::uint32_t owner,
                                    Angle swing, const PersonFigure* figure) {
    std::vector<MovingBody> bodies;
    addHumanBodies(height, pose, owner, swing, {}, bodies, figure);
    return bodies;
}

std::vector<MovingBody> bodiesOf(const Scene& scene) {
    std::vector<MovingBody> bodies;
    bodies.reserve(scene.robots.size());
    for (const PlacedRobot& robot : scene.robots)
        bodies.push_back(
            robotBody(robot.model, robot.pose, static_cast<std::uint32_t>(bodies.size())));
    std::uint32_t owner = kFirstPerson;
    for (const PlacedPerson& person : scene.people) {
        const std::vector<MovingBody> parts =
            humanBodies(person.height, person.pose, owner++, {}, person.figure.get());
        bodies.insert(bodies.end(), parts.begin(), parts.end());
    }
    return bodies;
}

MoverVelocity MoverVelocities::of(std::uint32_t owner) const {
    const bool is_person = owner >= kFirstPerson && owner != MovingBodies::kNoOwner;
    const std::vector<MoverVelocity>& all = is_person ? people : robots;
    const std::size_t index = is_person ? owner - kFirstPerson : owner;
    return index < all.size() ? all[index] : MoverVelocity();
}

MoverVelocities startVelocities(const Scene& scene) {
    const auto of = [](const Pose2& pose, const MotionPlan& plan, double speed) {
        const auto next = std::find_if(plan.path.begin(), plan.path.end(),
                                       [&](Point2 point) { return point != pose.position; });
        MoverVelocity motion{pose.position, {}};
        if (next != plan.path.end()) {
            const Vec2 way = *next - pose.position;
            motion.linear = speed / length(way) * way;
        } else if (plan.wander) {
            motion.linear = speed * unitVector(pose.heading);
        }
        return motion;
    };
    MoverVelocities all;
    for (const PlacedRobot& robot : scene.robots)
        all.robots.push_back(of(robot.pose, robot.course, robot.model.speed));
    for (const PlacedPerson& person : scene.people)
        all.people.push_back(of(person.pose, person.course, person.speed));
    return all;
}

}  // namespace ispace
