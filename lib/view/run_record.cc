// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/run_record.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "view/view.h"

namespace ispace {

namespace {

constexpr std::string_view kColumns = "t,id,x,y,heading_deg";

std::vector<std::string_view> fieldsOf(std::string_view line) {
    std::vector<std::string_view> fields;
    for (;;) {
        const std::size_t comma = line.find(',');
        fields.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos) return fields;
        line.remove_prefix(comma + 1);
    }
}

}  // namespace

RunRecord::RunRecord(std::string_view bytes, const std::string& name) : name_(name) {
    int number = 0;
    bool has_header = false;
    while (!bytes.empty()) {
        const std::size_t end = bytes.find('\n');
        const std::string_view line = bytes.substr(0, end);
        bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
        ++number;
        if (line.empty() || line.front() == '#') continue;
        if (!has_header) {
            if (!line.starts_with(kColumns))
                throw FormatError({name, number, 0,
                                   "no record of a run: wanted the columns " +
                                       std::string(kColumns) + ",…, as `simrun --record` writes"});
            has_header = true;
            continue;
        }
        const std::vector<std::string_view> fields = fieldsOf(line);
        constexpr std::size_t kWanted = 5;
        if (fields.size() < kWanted)
            throw FormatError({name, number, 0, "too few columns: " + excerpt(line)});
        const auto t = parseDouble(fields[0]), x = parseDouble(fields[2]),
                   y = parseDouble(fields[3]), heading = parseDouble(fields[4]);
        if (!t || !x || !y || !heading)
            throw FormatError({name, number, 0, "not a pose: " + excerpt(line)});
        if (!steps_.empty() && *t < steps_.back().time)
            throw FormatError({name, number, 0, "time runs backwards"});
        steps_.push_back({*t, std::string(fields[1]), {{*x, *y}, Angle::degrees(*heading)}});
    }
    if (steps_.empty()) throw FormatError({name, 0, 0, "holds no pose of a robot"});
}

void RunRecord::apply(Scene& scene, double time) const {
    std::map<std::string, Pose2> poses;
    const auto later = std::upper_bound(steps_.begin(), steps_.end(), time,
                                        [](double t, const Step& step) { return t < step.time; });
    for (auto step = steps_.begin(); step != later; ++step) poses[step->id] = step->pose;
    for (const auto& entry : poses) {
        const std::string& id = entry.first;
        const auto robot = std::find_if(scene.robots.begin(), scene.robots.end(),
                                        [&id](const PlacedRobot& r) { return r.id == id; });
        if (robot == scene.robots.end())
            throw FormatError({name_, 0, 0, "the scene has no robot " + excerpt(id)});
        moveRobot(scene, static_cast<std::size_t>(robot - scene.robots.begin()), entry.second);
    }
}

std::vector<std::vector<Point2>> RunRecord::waysUntil(double time) const {
    std::map<std::string, std::vector<Point2>> ways;
    for (const Step& step : steps_) {
        if (step.time > time) break;
        std::vector<Point2>& way = ways[step.id];
        constexpr double kStep = 0.02;
        if (way.empty() || distance(way.back(), step.pose.position) > kStep)
            way.push_back(step.pose.position);
    }
    std::vector<std::vector<Point2>> out;
    for (auto& [id, way] : ways)
        if (way.size() > 1) out.push_back(std::move(way));
    return out;
}

}  // namespace ispace
