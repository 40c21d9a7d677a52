// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/learning/learning.h"

namespace ispace::extension {

Extension learning() {
    return {.name = "learning", .options = {{"simrun", learning::makeLearning}}};
}

}  // namespace ispace::extension
