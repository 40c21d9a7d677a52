// SPDX-License-Identifier: GPL-3.0-or-later
// The ways of people as elements for arrange to serve.
#pragma once

#include <memory>

#include "arrange/demand.h"
#include "extensions/presence/people_paths.h"

namespace ispace::presence {

/// Returns the demand of `--presence`: the pieces of these ways, by length, each served by a sensor
/// that detects the person there within kPresenceDelay, see PresenceView.
/// \param plane height at which people are detected
std::shared_ptr<const Demand> presenceDemand(std::shared_ptr<const PeoplePaths> ways, double plane);

}  // namespace ispace::presence
