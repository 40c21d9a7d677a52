// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/luxes/lux.h"

namespace ispace::extension {

Extension luxes() { return {.name = "luxes", .add = luxes::addLuxes}; }

}  // namespace ispace::extension
