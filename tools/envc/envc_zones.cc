// SPDX-License-Identifier: GPL-3.0-or-later
#include "envc/envc_options.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "env/environment.h"
#include "env/zone.h"
#include "scene/placement_schemas.h"

namespace ispace {

void addZones(std::span<const std::string> zones, Document& document) {
    if (zones.empty()) return;
    // Meshes that are not loaded bound no room.
    std::vector<Record> records = document.records;
    std::vector<std::string> ids = assignIds(records);
    for (std::size_t i = records.size(); i-- > 0;)
        if (records[i].keyword() == "mesh") {
            records.erase(records.begin() + static_cast<std::ptrdiff_t>(i));
            ids.erase(ids.begin() + static_cast<std::ptrdiff_t>(i));
        }
    for (Record& zone : zoneRecords(zones, Environment(records, ids), sceneSchemas()))
        document.records.push_back(std::move(zone));
}

}  // namespace ispace
