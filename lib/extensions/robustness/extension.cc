// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/robustness/robustness.h"

namespace ispace::extension {

Extension robustness() { return {.name = "robustness", .coverage = robustness::makeRobustness}; }

}  // namespace ispace::extension
