// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/goals: ways of intruders that sensors see least, errors of positions, and layouts
// of arrange for both. Here the ways through a building.
//
// Exact for the regions of the coverage, as findLeastSeenPath() is: no way over floors and the
// landings of stairs and lifts is seen for less, if all views are known exactly.
//
//     const PathChoice of{"ground/door", "upper/safe"};
//     const LeastSeenTrip trip = findLeastSeenTrip(building, coverage, of);
//     if (trip.whole.seen) print(*trip.whole.seen, trip.whole.length);     // metres
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/goals/least_seen_path.h"
#include "extensions/goals/objective_report.h"
#include "extensions/passages/site_passages.h"
#include "site/site_coverage.h"
#include "site/site_scene.h"

namespace ispace::goals {

/// A way over the floors of storeys, between which it takes stairs and lifts.
struct LeastSeenTrip {
    /// A way on one storey: from the zone or a landing to the zone or a landing. LeastSeenPath::of
    /// has the ids of zones across the building, and those of stairs and lifts.
    struct Part {
        std::size_t storey = 0;
        LeastSeenPath way;
    };
    /// From zone to zone, with the sums over the parts; without pieces, as those are in the frames
    /// of the storeys. Its `seen` is empty if that of a part is.
    LeastSeenPath whole;
    std::vector<Part> parts = {};  ///< in order; empty without a way
};

/// Finds the way of a person between two zones of which the least length is seen; of those seen for
/// the same length, the shortest. Sight does not count on landings (within 0.3 m of where a person
/// enters), on stairs and in lifts, as in reports of runs; lifts stop at all their storeys.
///
/// Floor counts as seen if `times` sensors see it. In a room alone, and on one storey, this is
/// findLeastSeenPath(), or a way over other storeys that is seen less. Costs one
/// findLeastSeenPath() for each pair of landings of a storey. \param of `ground/entrance` or a zone
/// that only one storey has \throws UsageError for a zone that no storey or more than one has, and
/// as findLeastSeenPath()
LeastSeenTrip findLeastSeenTrip(const SiteScene& building, const SiteCoverage& coverage,
                                const PathChoice& of, int times = 1);

/// A zone of a storey.
struct StoreyZone {
    std::size_t storey = 0;
    std::string zone;  ///< as readZone() takes it
};
/// Finds the storey of a zone, as findLeastSeenTrip() does. \param option for messages
/// \throws UsageError for a zone that no storey or more than one has
StoreyZone zoneOfStorey(const SiteScene& building, std::string_view option,
                        const std::string& text);

/// Figures of objectives on each storey, and of the building.
struct SiteObjectives {
    std::vector<ObjectiveFigures> storeys;
    ObjectiveFigures all;
};
/// Measures the least seen ways through the building, their parts on each storey, and positions on
/// each storey and over all. \param localise_to limit of errors, metres; empty: no positions
SiteObjectives measureObjectives(const SiteScene& building, const SiteCoverage& coverage,
                                 std::span<const PathChoice> ways, int times,
                                 std::optional<double> localise_to);

}  // namespace ispace::goals
