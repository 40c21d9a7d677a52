// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/leds/led.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension leds() {
    return {.name = "leds", .add = [] {
                addSceneSchemas(ledSchemas());
                addLeds();
            }};
}

}  // namespace ispace::extension
