// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/ifc/ifc.h"

namespace ispace::extension {

Extension ifc() { return {.name = "ifc", .add = ifc::addIfc}; }

}  // namespace ispace::extension
