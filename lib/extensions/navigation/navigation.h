// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::navigation {

/// Returns the options of `coverage --run DIR --goal X,Y`.
std::unique_ptr<OptionGroup> makeNavigationJudge();

}  // namespace ispace::navigation
