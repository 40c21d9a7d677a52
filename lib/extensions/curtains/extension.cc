// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/curtains/curtain.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension curtains() {
    return {.name = "curtains", .add = [] {
                addSceneSchemas(curtains::curtainSchemas());
                curtains::addCurtains();
            }};
}

}  // namespace ispace::extension
