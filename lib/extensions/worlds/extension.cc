// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"

namespace ispace::extension {

Extension worlds() { return {.name = "worlds"}; }

}  // namespace ispace::extension
