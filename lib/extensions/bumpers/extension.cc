// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/bumpers/bumper.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension bumpers() {
    return {.name = "bumpers",
            .add =
                [] {
                    addSceneSchemas(bumpers::bumperSchemas());
                    bumpers::addBumpers();
                },
            .role = bumpers::makeBumpers};
}

}  // namespace ispace::extension
