// SPDX-License-Identifier: GPL-3.0-or-later
// --floor of scan: one reading of each floor and seat, before a run.
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::pressure {

/// Makes the option --floor of scan: readings of floors and seats with robots and people at their
/// starts, a line of JSON each.
std::unique_ptr<OptionGroup> makePressureOptions();

}  // namespace ispace::pressure
