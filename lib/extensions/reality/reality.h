// SPDX-License-Identifier: GPL-3.0-or-later
// Options of scan that compare a log with a plan.
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::reality {

/// The options --against, --align, --json, --require, --report and --fit of scan.
std::unique_ptr<OptionGroup> makeRealityOptions();

}  // namespace ispace::reality
