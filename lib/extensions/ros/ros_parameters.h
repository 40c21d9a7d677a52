// SPDX-License-Identifier: GPL-3.0-or-later
// Values of the run as parameters of its node.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

namespace ispace {
class ServerState;
}

namespace ispace::ros {

/// A value of the running world by name: `clock.paused`, `clock.rate`, and `ID.at` and
/// `ID.heading` (metres, degrees) of robots, people, and fixed sensors, with ids across the worlds
/// of a run.
struct RosParameter {
    std::string name;
    std::variant<bool, double, std::vector<double>> value;
};
std::vector<RosParameter> rosParameters(ServerState& state);

/// Returns the name of a parameter without that of its node, which rosapi puts before it: "r1.at"
/// of
/// "/simrun:r1.at".
std::string parameterNamed(const std::string& name);

/// The request that sets a parameter, "SET r1.at=1,2" or "PAUSE", or the reason why it cannot be
/// set.
struct RosSetting {
    std::string request, refusal;
};
RosSetting settingOf(ServerState& state, const std::string& name, const nlohmann::json& value);

}  // namespace ispace::ros
