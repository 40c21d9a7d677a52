// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_parameters.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/message.h"
#include "base/number.h"
#include "server/server_state.h"

namespace ispace::ros {

namespace {

constexpr const char *kPaused = "clock.paused", *kRate = "clock.rate";

}  // namespace

std::vector<RosParameter> rosParameters(ServerState& state) {
    const Simulation& simulation = state.simulation();
    std::vector<RosParameter> out{{kPaused, simulation.paused()}, {kRate, simulation.clock().rate}};
    for (const auto& [room, world] : state.worlds()) {
        for (std::size_t i = 0; i < world->movers().size(); ++i) {
            const Pose2 pose = world->status(i).pose;
            const std::string id = nameAcross(room, world->movers()[i].id);
            out.push_back({id + ".at", std::vector{pose.position.x, pose.position.y}});
            out.push_back({id + ".heading", pose.heading.degrees()});
        }
        for (const Sensor& sensor : world->sensors()) {
            if (sensor.mount || sensor.person) continue;
            const Point3 place = sensor.pose.position;
            const std::string id = nameAcross(room, sensor.id);
            out.push_back({id + ".at", std::vector{place.x, place.y, place.z}});
            out.push_back({id + ".heading", sensor.pose.heading.degrees()});
        }
    }
    return out;
}

std::string parameterNamed(const std::string& name) {
    for (const std::string_view node : {"/simrun:", "simrun:"})
        if (name.starts_with(node)) return name.substr(node.size());
    return name;
}

RosSetting settingOf(ServerState& state, const std::string& name, const nlohmann::json& value) {
    const std::vector<RosParameter> all = rosParameters(state);
    const auto known = std::find_if(all.begin(), all.end(),
                                    [&](const RosParameter& one) { return one.name == name; });
    if (known == all.end()) return {"", "there is no parameter " + excerpt(name)};
    if (std::holds_alternative<bool>(known->value)) {
        if (!value.is_boolean()) return {"", excerpt(name) + " is true or false"};
        return {value.get<bool>() ? "PAUSE" : "RESUME", ""};
    }
    if (std::holds_alternative<double>(known->value)) {
        if (!value.is_number()) return {"", excerpt(name) + " is a number"};
        return {(name == kRate ? "RATE " : "SET " + name + "=") + formatDouble(value), ""};
    }
    const std::size_t size = std::get<std::vector<double>>(known->value).size();
    const bool is_list =
        value.is_array() && value.size() == size &&
        std::all_of(value.begin(), value.end(), [](const auto& one) { return one.is_number(); });
    if (!is_list) return {"", excerpt(name) + " is a list of " + std::to_string(size) + " numbers"};
    std::string out = "SET " + name + "=";
    for (const auto& one : value)
        out.append(out.ends_with('=') ? "" : ",").append(formatDouble(one));
    return {out, ""};
}

}  // namespace ispace::ros
