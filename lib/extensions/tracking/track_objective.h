// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cli/objective_extension.h"

namespace ispace::tracking {

/// Returns the objective and options of `arrange --objective track`.
std::unique_ptr<ObjectiveGroup> makeTrackObjective();

}  // namespace ispace::tracking
