// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

#include "sim/simulation.h"

namespace ispace {

/// A value of the running world by name: `clock.paused`, `clock.rate`, and `ID.at` and
/// `ID.heading` (metres, degrees) of robots, people, and sensors that nobody carries.
struct RosParameter {
    std::string name;
    std::variant<bool, double, std::vector<double>> value;
};
/// \param with_things else those of the clock alone
std::vector<RosParameter> rosParameters(const Simulation& simulation, bool with_things = true);

/// Returns the name of a parameter without that of its node, which rosapi puts before it: "r1.at"
/// of
/// "/simrun:r1.at".
std::string parameterNamed(const std::string& name);

/// The request that sets a parameter, "SET r1.at=1,2" or "PAUSE", or the reason why it cannot be
/// set.
struct RosSetting {
    std::string request, refusal;
};
/// \param with_things as for rosParameters()
RosSetting settingOf(const Simulation& simulation, bool with_things, const std::string& name,
                     const nlohmann::json& value);

}  // namespace ispace
