// SPDX-License-Identifier: GPL-3.0-or-later
// The options of coverage that judge a robot's way to a goal by the record of a run.
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::navigation {

/// Returns the options of `coverage --run DIR --goal X,Y`.
std::unique_ptr<OptionGroup> makeNavigationJudge();

}  // namespace ispace::navigation
