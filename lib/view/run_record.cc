// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/run_record.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "layout/movement.h"
#include "sensor/kind.h"
#include "sensor/sensor.h"
#include "view/view.h"

namespace ispace {

namespace {

bool has(const Scene& scene, const std::string& id) {
    return std::find(scene.ids.begin(), scene.ids.end(), id) != scene.ids.end();
}

/// With the sensors that she carries.
void movePerson(Scene& scene, std::size_t person, const Pose2& pose) {
    const Pose2 before = std::exchange(scene.people[person].pose, pose);
    for (Placed& placed : scene.placed) {
        const std::string& keyword = scene.records[placed.record].keyword();
        if (keyword == "human" && placed.index == person) {
            placed.pose = {
                {pose.position.x, pose.position.y, placed.pose.position.z}, pose.heading, {}, {}};
        } else if (sensorKind(keyword) != nullptr) {
            Sensor& sensor = scene.sensors[placed.index];
            if (sensor.person != person) continue;
            placed.pose = sensor.pose = mountedPose(pose, poseOn(before, sensor.pose));
        }
    }
}

}  // namespace

RunRecord::RunRecord(RunReader reader) : name_(reader.name()) {
    while (reader.next())
        for (const RunState& state : reader.states())
            steps_.push_back({reader.time(), state.who, state.pose,
                              limbSwing(state.phase, std::hypot(state.speed, state.sidespeed))});
    who_ = reader.who();
    if (steps_.empty()) throw FormatError({name_, 0, 0, "holds no pose of a robot"});
}

void RunRecord::checkStart(const Scene& scene) const {
    // One that begins later began with nobody.
    if (begin() > 0) return;
    for (const Step& step : steps_) {
        if (step.time > begin()) return;
        const RunMember& member = who_[step.who];
        if (!has(scene, member.id))
            throw FormatError({name_, 0, 0,
                               std::string("the scene has no ") +
                                   (member.is_person ? "person " : "robot ") + excerpt(member.id)});
    }
}

std::map<std::size_t, const RunRecord::Step*> RunRecord::lastSteps(double time) const {
    std::map<std::size_t, const Step*> last;
    const auto later = std::upper_bound(steps_.begin(), steps_.end(), time,
                                        [](double t, const Step& step) { return t < step.time; });
    for (auto step = steps_.begin(); step != later; ++step) last[step->who] = &*step;
    return last;
}

std::vector<Angle> RunRecord::swingsAt(const Scene& scene, double time) const {
    std::vector<Angle> swings(scene.people.size());
    for (const auto& [who, step] : lastSteps(time))
        for (std::size_t i = 0; i < swings.size(); ++i)
            if (scene.people[i].id == who_[who].id) swings[i] = step->swing;
    return swings;
}

void RunRecord::apply(Scene& scene, double time) const {
    for (const auto& [who, step] : lastSteps(time)) {
        const auto index_in = [&id = who_[who].id](const auto& list) {
            const auto found = std::find_if(list.begin(), list.end(),
                                            [&id](const auto& one) { return one.id == id; });
            return static_cast<std::size_t>(found - list.begin());
        };
        const std::size_t robot = index_in(scene.robots), person = index_in(scene.people);
        if (robot < scene.robots.size())
            moveRobot(scene, robot, step->pose);
        else if (person < scene.people.size())
            movePerson(scene, person, step->pose);
    }
}

std::vector<std::vector<Point2>> RunRecord::waysUntil(double time) const {
    std::map<std::size_t, std::vector<Point2>> ways;
    for (const Step& step : steps_) {
        if (step.time > time) break;
        std::vector<Point2>& way = ways[step.who];
        constexpr double kStep = 0.02;
        if (way.empty() || distance(way.back(), step.pose.position) > kStep)
            way.push_back(step.pose.position);
    }
    std::vector<std::vector<Point2>> out;
    for (auto& [who, way] : ways)
        if (way.size() > 1) out.push_back(std::move(way));
    return out;
}

}  // namespace ispace
