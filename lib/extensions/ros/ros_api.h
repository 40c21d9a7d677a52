// SPDX-License-Identifier: GPL-3.0-or-later
// The services of rosapi, for clients of rosbridge that list topics, services and types.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "extensions/ros/ros_feed.h"

namespace ispace::ros {

/// Answers a service of the node rosapi, by which clients of rosbridge look around.
/// \param name without a leading slash: "rosapi/topics" \returns the values of the answer as JSON;
/// empty for other services
std::optional<std::string> rosApi(const RosFeed& feed, const Simulation& simulation,
                                  std::string_view name, const nlohmann::json& arguments);

}  // namespace ispace::ros
