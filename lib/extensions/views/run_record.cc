// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/run_record.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "extensions/views/view.h"
#include "scene/bodies.h"
#include "scene/sensor/sensor.h"

namespace ispace::views {

namespace {

bool has(const Scene& scene, const std::string& id) {
    return std::find(scene.ids.begin(), scene.ids.end(), id) != scene.ids.end();
}

/// Moves a person, with the sensors that it carries.
void movePerson(Scene& scene, std::size_t person, const Pose2& pose) {
    const Pose2 before = std::exchange(scene.people[person].pose, pose);
    for (PlacedRecord& placed : scene.placed) {
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
            steps_.push_back({reader.time(), state.member, state.pose,
                              limbSwing(state.phase, std::hypot(state.speed, state.sidespeed))});
    members_ = reader.members();
    if (steps_.empty()) throw FormatError({name_, 0, 0, "holds no pose of a robot"});
}

void RunRecord::checkStart(const Scene& scene) const {
    // A record that begins later may begin without movers.
    if (begin() > 0) return;
    for (const Step& step : steps_) {
        if (step.time > begin()) return;
        const RunMember& member = members_[step.member];
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
    for (auto step = steps_.begin(); step != later; ++step) last[step->member] = &*step;
    return last;
}

std::vector<Angle> RunRecord::swingsAt(const Scene& scene, double time) const {
    std::vector<Angle> swings(scene.people.size());
    for (const auto& [member, step] : lastSteps(time))
        for (std::size_t i = 0; i < swings.size(); ++i)
            if (scene.people[i].id == members_[member].id) swings[i] = step->swing;
    return swings;
}

void RunRecord::apply(Scene& scene, double time) const {
    for (const auto& [member, step] : lastSteps(time)) {
        const auto index_in = [&id = members_[member].id](const auto& list) {
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
        std::vector<Point2>& way = ways[step.member];
        constexpr double kStep = 0.02;
        if (way.empty() || distance(way.back(), step.pose.position) > kStep)
            way.push_back(step.pose.position);
    }
    std::vector<std::vector<Point2>> out;
    for (auto& [member, way] : ways)
        if (way.size() > 1) out.push_back(std::move(way));
    return out;
}

}  // namespace ispace::views
