// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/maps/maps.h"
#include "io/importers.h"

namespace ispace::extension {

Extension maps() {
    return {.name = "maps", .add = [] { addImporters(maps::mapImporters()); }};
}

}  // namespace ispace::extension
