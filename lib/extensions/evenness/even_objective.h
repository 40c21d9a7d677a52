// SPDX-License-Identifier: GPL-3.0-or-later
// The objective `even` of arrange, with --depth and --further. It counts sensors on one spot by
// itself, and refuses --redundancy (UsageError).
#pragma once

#include <memory>

#include "cli/objective_extension.h"

namespace ispace::evenness {

/// Returns the objective and options of `arrange --objective even`.
std::unique_ptr<ObjectiveGroup> makeEvenObjective();

}  // namespace ispace::evenness
