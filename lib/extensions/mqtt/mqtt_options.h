// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cli/run_bridge.h"

namespace ispace::mqtt {

/// Returns the option --mqtt of simrun and its like.
std::unique_ptr<BridgeGroup> makeMqttOptions();

}  // namespace ispace::mqtt
