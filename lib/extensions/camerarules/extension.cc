// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/camerarules/coverage_rules.h"
#include "extensions/camerarules/layout_rules.h"

namespace ispace::extension {

Extension camerarules() {
    return {.name = "camerarules",
            .arrange = camerarules::makeLayoutRules,
            .coverage = camerarules::makeCoverageRules};
}

}  // namespace ispace::extension
