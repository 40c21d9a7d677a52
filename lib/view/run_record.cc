// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/run_record.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/message.h"
#include "view/view.h"

namespace ispace {

namespace {

bool has(const Scene& scene, const std::string& id) {
    return std::find(scene.ids.begin(), scene.ids.end(), id) != scene.ids.end();
}

void movePerson(Scene& scene, const std::string& id, const Pose2& pose) {
    for (Placed& placed : scene.placed)
        if (scene.ids[placed.record] == id)
            placed.pose = {
                {pose.position.x, pose.position.y, placed.pose.position.z}, pose.heading, {}, {}};
}

}  // namespace

RunRecord::RunRecord(RunReader reader) : name_(reader.name()) {
    while (reader.next())
        for (const RunState& state : reader.states())
            steps_.push_back({reader.time(), state.who, state.pose});
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

void RunRecord::apply(Scene& scene, double time) const {
    std::map<std::size_t, Pose2> poses;
    const auto later = std::upper_bound(steps_.begin(), steps_.end(), time,
                                        [](double t, const Step& step) { return t < step.time; });
    for (auto step = steps_.begin(); step != later; ++step) poses[step->who] = step->pose;
    for (const auto& [who, pose] : poses) {
        const std::string& id = who_[who].id;
        if (!has(scene, id)) continue;
        const auto robot = std::find_if(scene.robots.begin(), scene.robots.end(),
                                        [&id](const PlacedRobot& r) { return r.id == id; });
        if (robot != scene.robots.end())
            moveRobot(scene, static_cast<std::size_t>(robot - scene.robots.begin()), pose);
        else
            movePerson(scene, id, pose);
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
