// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/evenness/even_objective.h"

namespace ispace::extension {

Extension evenness() { return {.name = "evenness", .objectives = {evenness::makeEvenObjective}}; }

}  // namespace ispace::extension
