// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/runs/run_options.h"

namespace ispace::extension {

Extension runs() {
    return {.name = "runs", .coverage = runs::makeRunGroup, .record = runs::makeRunReport};
}

}  // namespace ispace::extension
