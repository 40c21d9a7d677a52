// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/tracking/track_objective.h"

namespace ispace::extension {

Extension tracking() { return {.name = "tracking", .objectives = {tracking::makeTrackObjective}}; }

}  // namespace ispace::extension
