// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/ros/ros_options.h"

namespace ispace::extension {

Extension ros() { return {.name = "ros", .bridge = ros::makeRosOptions}; }

}  // namespace ispace::extension
