// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/leds/led.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension leds() {
    return {.name = "leds", .add = [] {
                addSceneSchemas(leds::ledSchemas());
                leds::addLeds();
            }};
}

}  // namespace ispace::extension
