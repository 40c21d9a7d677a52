// SPDX-License-Identifier: GPL-3.0-or-later
// Topics of ROS in simrun: over WebSockets, over DDS, and in a file.
#pragma once

#include <memory>

#include "cli/run_bridge.h"

namespace ispace::ros {

/// Returns the options of simrun about topics of ROS: --foxglove, --rosbridge, --ros2, --mcap.
std::unique_ptr<BridgeGroup> makeRosOptions();

}  // namespace ispace::ros
