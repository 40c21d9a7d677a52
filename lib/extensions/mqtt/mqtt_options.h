// SPDX-License-Identifier: GPL-3.0-or-later
// The option --mqtt of simrun: states of the room to and from a broker.
#pragma once

#include <memory>

#include "cli/run_bridge.h"

namespace ispace::mqtt {

/// Returns the option --mqtt of simrun and its like.
std::unique_ptr<BridgeGroup> makeMqttOptions();

}  // namespace ispace::mqtt
