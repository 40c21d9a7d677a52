// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/reality/reality.h"

namespace ispace::extension {

Extension reality() {
    return {.name = "reality", .options = {{"scan", reality::makeRealityOptions}}};
}

}  // namespace ispace::extension
