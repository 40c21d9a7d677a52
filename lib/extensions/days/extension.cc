// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/days/activity.h"

namespace ispace::extension {

Extension days() { return {.name = "days", .add = days::addDays}; }

}  // namespace ispace::extension
