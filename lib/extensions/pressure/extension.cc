// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/pressure/pressure_record.h"
#include "extensions/pressure/pressure_role.h"
#include "extensions/pressure/pressure_scan.h"
#include "scene/placement_schemas.h"

namespace ispace::extension {

Extension pressure() {
    return {.name = "pressure",
            .add =
                [] {
                    addSceneSchemas(pressure::pressureSchemas());
                    pressure::addPressureChecks();
                },
            .options = {{"scan", pressure::makePressureOptions}},
            .role = pressure::makePressure};
}

}  // namespace ispace::extension
