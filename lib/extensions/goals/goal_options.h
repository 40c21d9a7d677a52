// SPDX-License-Identifier: GPL-3.0-or-later
// `coverage --path` and `--localise`, `arrange --objective path` and `localise`: their words, what
// they refuse, and the figures of a layout in them. arrange judges its layouts by the figures of
// coverage, exactly, and not by the cells of its search.
#pragma once

#include <memory>

#include "cli/coverage_group.h"
#include "cli/objective_extension.h"

namespace ispace::goals {

std::unique_ptr<CoverageGroup> makeGoalFigures();
std::unique_ptr<ObjectiveGroup> makePathGoal();
std::unique_ptr<ObjectiveGroup> makeLocaliseGoal();

}  // namespace ispace::goals
