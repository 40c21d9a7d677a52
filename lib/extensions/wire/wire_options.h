// SPDX-License-Identifier: GPL-3.0-or-later
// Options of simrun for the protocols of real devices.
#pragma once

#include <memory>

#include "cli/run_bridge.h"

namespace ispace::wire {

/// Returns an option of simrun for each protocol of a real device, and their clock.
std::unique_ptr<BridgeGroup> makeWireOptions();

}  // namespace ispace::wire
