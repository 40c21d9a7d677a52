// SPDX-License-Identifier: GPL-3.0-or-later
// Buildings, in this process: each is read and its storeys become records, or it is refused.
#include "fuzz.h"

#include "extensions/ifc/ifc_import.h"
#include "extensions/ifc/reader/building.h"
#include "extensions/ifc/storey_import.h"
#include "scene/placement_schemas.h"

void ispace::fuzz::tryInput(std::string_view bytes) {
    Budget work(bytes.size());
    ifc::Building building;
    try {
        building = ifc::unpackedBuilding(
            ifc::packedBuilding(ifc::readBuilding(bytes, std::nullopt, work)));
    } catch (const std::runtime_error&) {
        return;  // an answer of the reader's process
    }
    ImportRecords out(sceneSchemas(), "x.ifc", {});
    ifc::writeStorey(building, ifc::chosenStorey(building, {}), {}, work, out);
}
