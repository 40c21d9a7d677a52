// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "layout/run_changes.h"

namespace ispace {

/// The changes that clients made to the world of a recorded run, which began in a scene.
/// \throws FormatError if events.csv holds no events
RunChanges changesOfRun(const std::string& folder, const Scene& start);

}  // namespace ispace
