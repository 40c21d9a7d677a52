// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/robustness/robust_options.h"
#include "extensions/robustness/robustness.h"

namespace ispace::extension {

Extension robustness() {
    return {.name = "robustness",
            .arrange = robustness::makeRobustLayouts,
            .coverage = robustness::makeRobustness};
}

}  // namespace ispace::extension
