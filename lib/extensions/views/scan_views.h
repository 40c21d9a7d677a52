// SPDX-License-Identifier: GPL-3.0-or-later
// scan --view: pictures of the room instead of readings.
#pragma once

#include <memory>

#include "cli/option_group.h"

namespace ispace::views {

std::unique_ptr<OptionGroup> makeViewOptions();

}  // namespace ispace::views
