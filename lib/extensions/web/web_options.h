// SPDX-License-Identifier: GPL-3.0-or-later
// The option --web of simrun: the page of a run in a browser.
#pragma once

#include <memory>

#include "cli/run_bridge.h"

namespace ispace::web {

/// Returns the option --web of simrun and its like.
std::unique_ptr<BridgeGroup> makeWebOptions();

}  // namespace ispace::web
