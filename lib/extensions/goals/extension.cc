// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/goals/goal_options.h"

namespace ispace::extension {

Extension goals() {
    return {.name = "goals",
            .objectives = {goals::makePathGoal, goals::makeLocaliseGoal},
            .coverage = goals::makeGoalFigures};
}

}  // namespace ispace::extension
