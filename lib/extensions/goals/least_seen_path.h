// SPDX-License-Identifier: GPL-3.0-or-later
// The way of an intruder over the floor of one room that sensors see for the least length.
//
// Exact for the regions of the coverage, on which see leastExposedPath(); a way through a building
// is findLeastSeenTrip(). Deterministic. Costs an overlay of the free floor, the views and the
// zones, and lines of sight between corners of unseen floor.
//
//     const LeastSeenPath way = findLeastSeenPath(scene, coverage, parseWay("entrance,vault"));
//     if (way.exists && way.seen) print(*way.seen, way.length);     // metres
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coverage/coverage.h"
#include "env/environment.h"
#include "scene/scene.h"

namespace ispace::goals {

/// The zones between which an intruder goes.
struct PathChoice {
    std::string from, to;
};

/// Parses `entrance,vault`. \throws UsageError
PathChoice parseWay(std::string_view text);

/// A way over free floor, of which a part is seen.
struct LeastSeenPath {
    /// A straight piece, seen or unseen from end to end; a zone counts as unseen.
    struct Piece {
        Point2 from, to;
        bool is_seen = false;
    };

    PathChoice of;
    bool exists = true;  ///< false: no way on free floor joins the zones
    /// Length that sensors see, metres, exact; empty without a way, or if a view is known by cells
    /// only.
    std::optional<double> seen = {};
    double length = 0;               ///< of the whole way, metres
    std::vector<Piece> pieces = {};  ///< from an inner point of one zone to one of the other
};

/// Finds the way of a point between two zones, over the free floor, of which the shortest length is
/// seen by at least `times` sensors. It begins and ends anywhere in the zones, in which sight does
/// not count. Exact for the regions of the overlay, see leastExposedPath(). Of the ways that are
/// seen least it is any; its unseen parts are as short as they can be between the seen ones.
/// \throws UsageError for an unknown zone, and for one without free floor
LeastSeenPath findLeastSeenPath(const Scene& scene, const Coverage& coverage, const PathChoice& of,
                                int times = 1);

}  // namespace ispace::goals
