// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cli/objective_extension.h"

namespace ispace::evenness {

/// Returns the objective and options of `arrange --objective even`.
std::unique_ptr<ObjectiveGroup> makeEvenObjective();

}  // namespace ispace::evenness
