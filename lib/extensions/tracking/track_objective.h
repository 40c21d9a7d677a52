// SPDX-License-Identifier: GPL-3.0-or-later
// The objective track of arrange: least loss of people by a tracker.
#pragma once

#include <memory>

#include "cli/objective_extension.h"

namespace ispace::tracking {

/// Returns the objective and options of `arrange --objective track`.
std::unique_ptr<ObjectiveGroup> makeTrackObjective();

}  // namespace ispace::tracking
