// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/motes/mote.h"

namespace ispace::extension {

Extension motes() { return {.name = "motes", .add = motes::addMotes}; }

}  // namespace ispace::extension
