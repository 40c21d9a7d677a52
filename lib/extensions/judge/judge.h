// SPDX-License-Identifier: GPL-3.0-or-later
// The options of coverage that judge a tracker by a recorded run. The record is read once, in the
// order of time; MOTA and its kin are computed after it.
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::judge {

/// Returns the options of `coverage --run DIR --tracks FILE`.
std::unique_ptr<OptionGroup> makeTrackJudge();

}  // namespace ispace::judge
