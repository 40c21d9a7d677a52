// SPDX-License-Identifier: GPL-3.0-or-later
// The way of an intruder through a building that sensors see least.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "building/building_coverage.h"
#include "building/building_scene.h"
#include "coverage/least_seen_way.h"

namespace ispace {

/// A way over the floors of storeys, between which it takes stairs and lifts.
struct LeastSeenTrip {
    /// A way on one storey: from the zone or a landing to the zone or a landing. LeastSeenWay::of
    /// has the ids of zones across the building, and those of stairs and lifts.
    struct Part {
        std::size_t storey = 0;
        LeastSeenWay way;
    };
    /// From zone to zone, with the sums over the parts; without pieces, as those are in the frames
    /// of the storeys. Its `seen` is empty if that of a part is.
    LeastSeenWay whole;
    std::vector<Part> parts = {};  ///< in order; empty without a way
};

/// Finds the way of a person between two zones of which the least length is seen; of those seen for
/// the same length, the shortest. Sight does not count on landings (within 0.3 m of where a person
/// enters), on stairs and in lifts, as in reports of runs; lifts stop at all their storeys.
///
/// On one storey this is findLeastSeenWay(), or a way over other storeys that is seen less. Costs
/// one findLeastSeenWay() for each pair of landings of a storey.
/// \param of `ground/entrance` or a zone that only one storey has
/// \throws UsageError for a zone that no storey or more than one has, and as findLeastSeenWay()
LeastSeenTrip findLeastSeenTrip(const BuildingScene& building, const BuildingCoverage& coverage,
                                const WayChoice& of);

}  // namespace ispace
