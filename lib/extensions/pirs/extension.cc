// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/pirs/pir.h"

namespace ispace::extension {

Extension pirs() { return {.name = "pirs", .add = pirs::addPirs}; }

}  // namespace ispace::extension
