// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/webots/webots.h"
#include "io/importers.h"

namespace ispace::extension {

Extension webots() {
    return {.name = "webots", .add = [] { addImporters(webots::webotsImporters()); }};
}

}  // namespace ispace::extension
