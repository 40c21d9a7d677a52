// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/appliances/appliance.h"
#include "extensions/appliances/meter_role.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension appliances() {
    return {.name = "appliances",
            .add =
                [] {
                    addSceneSchemas(appliances::applianceSchemas());
                    appliances::addAppliances();
                },
            .role = appliances::makeMeters};
}

}  // namespace ispace::extension
