// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/ros: the topics and numbers of Nav2's action `navigate_to_pose`, over DDS and
// rosbridge alike.
#pragma once

#include <cstdint>
#include <string_view>

#include "extensions/ros/ros_orders.h"

namespace ispace::ros {

/// Behind the topics of a robot: a goal as a message, and as an action with its result.
constexpr std::string_view kGoalTopic = "/goal_pose", kNavigate = "/navigate_to_pose";

/// The numbers of action_msgs/msg/GoalStatus. Of a goal that it refuses, rosbridge has kUnknown.
constexpr std::int8_t kUnknown = 0, kExecuting = 2, kSucceeded = 4, kCanceled = 5, kAborted = 6;

/// Returns the number of a goal that ended so.
constexpr std::int8_t statusOf(RosGoalEnd end) {
    return end == RosGoalEnd::Reached    ? kSucceeded
           : end == RosGoalEnd::Canceled ? kCanceled
                                         : kAborted;
}

}  // namespace ispace::ros
