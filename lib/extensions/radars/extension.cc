// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/radars/radar.h"

namespace ispace::extension {

Extension radars() { return {.name = "radars", .add = radars::addRadars}; }

}  // namespace ispace::extension
