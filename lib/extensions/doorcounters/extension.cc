// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/doorcounters/doorcounter.h"

namespace ispace::extension {

Extension doorcounters() { return {.name = "doorcounters", .add = doorcounters::addDoorCounters}; }

}  // namespace ispace::extension
