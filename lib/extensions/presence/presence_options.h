// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/presence: the share of people's ways on which sensors of motion detect them, as a
// figure of coverage and as a goal of arrange: --presence.
#pragma once

#include <memory>

#include "cli/coverage_group.h"
#include "cli/objective_extension.h"

namespace ispace::presence {

/// Makes the option of `coverage`, and its requirements "presence:95%".
std::unique_ptr<CoverageGroup> makePresence();
/// Makes the option of `arrange`.
std::unique_ptr<ObjectiveGroup> makePresenceObjective();

}  // namespace ispace::presence
