// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "building/building_scene.h"
#include "scene/sensor_spec.h"

namespace ispace {

/// Equal sensors shared out over the storeys of a building.
struct BuildingArrangement {
    std::vector<int> counts;           ///< of sensors, by storey
    std::vector<bool> has_floor;       ///< by storey; false: all of its floor is open
    std::vector<SensorGroup> groups;   ///< the group of each storey
    std::vector<Arrangement> storeys;  ///< without sensors where the count is 0
    double coverage = 0;               ///< of the indoor floor of all storeys
    double area = 0;                   ///< m2, total effective area by cells
    double value = 0;                  ///< share by the cells of the search
    double bound = 1;                  ///< upper bound of `value` for every split
    double rounding = 0;               ///< in the bound: a gap up to this is none
    std::size_t candidates = 0;        ///< of all storeys
    bool is_complete = true;
};

/// Shares `count` sensors out over the storeys, and arranges those of each storey.
///
/// Each storey is searched with 1, 2, ... `count` sensors, and storeys of which candidates see each
/// other through openings are searched together (JoinedRooms); shareOut() chooses the split. As no
/// candidate sees a storey of another part, the bound over all splits is a bound of the building. A
/// storey weighs as much as its indoor area; one without a floor has none and gets no sensors.
/// Equal storeys are searched once. \pre the scenes hold no sensors; options have neither target
/// nor budget and do not refine \throws as arrange()
BuildingArrangement arrangeBuilding(const BuildingScene& building, const SensorSpec& sensor,
                                    int count, const ArrangeOptions& options, Progress& progress);

/// Builds a `.3dm` of the building: `environment`, the sensors with their storeys, `result`.
Document buildingLayout(const LayoutParts& parts, const BuildingScene& building,
                        const BuildingArrangement& arrangement);

}  // namespace ispace
