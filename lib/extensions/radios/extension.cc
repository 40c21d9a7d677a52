// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/radios/radio.h"
#include "extensions/radios/radio_role.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension radios() {
    return {.name = "radios",
            .add =
                [] {
                    addSceneSchemas(radios::radioSchemas());
                    radios::addRadios();
                },
            .role = radios::makeRadios};
}

}  // namespace ispace::extension
