// SPDX-License-Identifier: GPL-3.0-or-later
// The floor from which people enter the stairs and lifts of a building: ends of ways on a storey.
//
//     for (const SitePassage& passage : sitePassages(building))
//         for (const SitePassage::Landing& landing : passage.landings)
//             print(passage.id, landing.room, landing.floor.low, landing.floor.high);
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geom/point.h"
#include "site/site_scene.h"

namespace ispace::passages {

/// Stairs or a lift: a way leads from any of its landings to any other one.
struct SitePassage {
    /// Floor of a room where people enter it, in the frame of the room.
    struct Landing {
        std::size_t room = 0;
        Box2 floor = {};
    };
    std::string id;
    std::vector<Landing> landings = {};
};

/// Returns the stairs and lifts of several storeys in the order of the building, each with a
/// landing for each stop: a square of 0.6 m about the spot from which a person of 1.75 m enters it.
/// Deterministic. Costs the obstacles of each storey with such a stop, as a run of the building.
std::vector<SitePassage> sitePassages(const SiteScene& building);

}  // namespace ispace::passages
