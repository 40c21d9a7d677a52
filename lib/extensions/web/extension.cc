// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/web/web_options.h"

namespace ispace::extension {

Extension web() { return {.name = "web", .bridge = web::makeWebOptions}; }

}  // namespace ispace::extension
