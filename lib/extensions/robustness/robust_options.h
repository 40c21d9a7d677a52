// SPDX-License-Identifier: GPL-3.0-or-later
// `arrange --robust`, `--crowd` and `--case`: layouts that are best in the worst of several cases,
// or in the mean.
#pragma once

#include <memory>

#include "cli/arrange_group.h"

namespace ispace::robustness {

std::unique_ptr<ArrangeGroup> makeRobustLayouts();

}  // namespace ispace::robustness
