// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/cad/cad.h"
#include "extensions/cad/dxf_plan.h"
#include "io/importers.h"

namespace ispace::extension {

Extension cad() {
    return {.name = "cad", .add = [] {
                addImporters(cad::cadImporters());
                cad::addDxfFormats();
            }};
}

}  // namespace ispace::extension
