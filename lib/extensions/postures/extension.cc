// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/postures/posture.h"

namespace ispace::extension {

Extension postures() { return {.name = "postures", .add = postures::addPostures}; }

}  // namespace ispace::extension
