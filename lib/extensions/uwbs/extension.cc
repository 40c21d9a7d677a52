// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/uwbs/uwb.h"

namespace ispace::extension {

Extension uwbs() { return {.name = "uwbs", .add = uwbs::addUwbs}; }

}  // namespace ispace::extension
