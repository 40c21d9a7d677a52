// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/projection/projection_options.h"

namespace ispace::extension {

Extension projection() {
    return {.name = "projection", .options = {{"coverage", projection::makeProjectionOptions}}};
}

}  // namespace ispace::extension
