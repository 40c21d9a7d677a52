// SPDX-License-Identifier: GPL-3.0-or-later
// lib/place: candidates and arranging. Uses cover, solve and below; TBB and CGAL inside.
#pragma once

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "base/program.h"
#include "base/progress.h"
#include "cover/tried_pose.h"
#include "layout/scene.h"
#include "place/arrange_options.h"
#include "place/sensor_group.h"

namespace ispace {

/// The coverage of a number of sensors.
struct CurvePoint {
    int sensors = 0;
    double value = 0;  ///< share covered by the best layout found
    double bound = 1;  ///< no layout of these candidates covers more
};

/// The sensors at their places, and what they cover.
struct Arrangement {
    std::vector<Placement> sensors;  ///< by group
    double coverage = 0;             ///< as `coverage` reports coverage.grid for the whole layout
    double area = 0;                 ///< total effective area by cells, m2, eq. (4.6)
    /// Share of the total weight; not set where it equals the coverage.
    std::optional<double> value;
    /// Upper bound of `value` (or coverage) over all that the search could choose or, if refining
    /// moved sensors off their candidates, over these sensors at any places.
    double bound = 1;
    double candidate_value = 0, candidate_bound = 1;  ///< before refining
    bool is_refined = false;                          ///< refining was asked for
    std::size_t candidates = 0, bytes = 0;            ///< of all kinds
    Grid grid;                                        ///< the cells while searching
    bool is_complete = true;                          ///< false: cut by time or a signal

    /// Sensors left unplaced, for lack of candidates or of candidates that keep coverage connected.
    std::size_t unplaced = 0;
    double cost = 0;         ///< of the sensors placed
    bool has_costs = false;  ///< they differ from 1
    /// With a target: whether it is reached, and a lower bound of the cost of reaching it.
    bool is_reached = true;
    std::optional<double> least;
    bool is_exhausted = false;  ///< not reached, not even by all candidates together

    /// Ids of sensors that, all together, add nothing to the others' value.
    std::vector<std::string> idle;

    std::vector<CurvePoint> curve;
    std::vector<TriedPose> tried;
    /// Exact weighted area, m2; equal if refining found nothing better: then all stand on
    /// candidates.
    double refined_before = 0, refined_after = 0;
};

/// Places the groups' sensors beside those that the scene has placed already.
///
/// Makes candidates by options.strategy for each kind of sensor, weighs the target's cells by
/// options.weights, then runs search() or minimumCostCover(), and refine() if asked. `mps`:
/// receives the model before the search. A shard (options.search.share) stores its steps and
/// returns an arrangement without sensors. \throws UnmetError if a kind has no valid
/// place or nothing may be bought, UsageError if the candidates do not fit in memory
Arrangement arrange(const Scene& scene, const std::vector<SensorGroup>& groups,
                    const ArrangeOptions& options, Progress& progress, std::ostream* mps = nullptr);

/// What goes into a layout besides the arrangement.
struct LayoutParts {
    History history;
    std::string environment_file;  ///< "" if there is none to name
    std::string environment_digest;
    std::string strategy, optimize;
};

/// A `.3dm`: the `environment` record, the records of `before` (if any) with its pending sensors
/// placed, the new sensors, the `result`.
Document layoutDocument(const LayoutParts& parts, const Document* before,
                        const std::vector<SensorGroup>& groups, const Arrangement& arrangement);

}  // namespace ispace
