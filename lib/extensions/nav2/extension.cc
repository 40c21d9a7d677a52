// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/nav2/masks.h"

namespace ispace::extension {

Extension nav2() { return {.name = "nav2", .add = nav2::addMasks}; }

}  // namespace ispace::extension
