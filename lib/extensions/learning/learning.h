// SPDX-License-Identifier: GPL-3.0-or-later
// The option --vector of simrun, which steps many worlds for a learner.
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::learning {

/// Returns the options of `simrun --vector N --shm NAME`.
std::unique_ptr<OptionGroup> makeLearning();

}  // namespace ispace::learning
