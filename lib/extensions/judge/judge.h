// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::judge {

/// Returns the options of `coverage --run DIR --tracks FILE`.
std::unique_ptr<OptionGroup> makeTrackJudge();

}  // namespace ispace::judge
