// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/ros/ros_parameters.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/number.h"

namespace ispace {

namespace {

constexpr const char *kPaused = "clock.paused", *kRate = "clock.rate";

}  // namespace

std::vector<RosParameter> rosParameters(const Simulation& simulation, bool with_things) {
    const World& world = simulation.world();
    std::vector<RosParameter> out{{kPaused, simulation.paused()}, {kRate, simulation.clock().rate}};
    if (!with_things) return out;
    for (std::size_t i = 0; i < world.movers().size(); ++i) {
        const Pose2 pose = world.status(i).pose;
        const std::string& id = world.movers()[i].id;
        out.push_back({id + ".at", std::vector{pose.position.x, pose.position.y}});
        out.push_back({id + ".heading", pose.heading.degrees()});
    }
    for (const Sensor& sensor : world.sensors()) {
        if (sensor.mount || sensor.person) continue;
        const Point3 place = sensor.pose.position;
        out.push_back({sensor.id + ".at", std::vector{place.x, place.y, place.z}});
        out.push_back({sensor.id + ".heading", sensor.pose.heading.degrees()});
    }
    return out;
}

std::string parameterNamed(const std::string& name) {
    for (const std::string_view node : {"/simrun:", "simrun:"})
        if (name.starts_with(node)) return name.substr(node.size());
    return name;
}

std::optional<std::string> requestToSet(const Simulation& simulation, bool with_things,
                                        const std::string& name, const nlohmann::json& value) {
    const std::vector<RosParameter> all = rosParameters(simulation, with_things);
    const auto known = std::find_if(all.begin(), all.end(),
                                    [&](const RosParameter& one) { return one.name == name; });
    if (known == all.end()) return std::nullopt;
    if (name == kPaused) {
        if (!value.is_boolean()) return std::nullopt;
        return value.get<bool>() ? "PAUSE" : "RESUME";
    }
    if (name == kRate) {
        if (!value.is_number()) return std::nullopt;
        return "RATE " + formatDouble(value);
    }
    const auto text_of = [](const nlohmann::json& number) { return formatDouble(number); };
    if (std::holds_alternative<double>(known->value)) {
        if (!value.is_number()) return std::nullopt;
        return "SET " + name + "=" + text_of(value);
    }
    const bool is_list =
        value.is_array() && value.size() == std::get<std::vector<double>>(known->value).size() &&
        std::all_of(value.begin(), value.end(), [](const auto& one) { return one.is_number(); });
    if (!is_list) return std::nullopt;
    std::string out = "SET " + name + "=";
    for (const auto& one : value) out.append(out.ends_with('=') ? "" : ",").append(text_of(one));
    return out;
}

}  // namespace ispace
