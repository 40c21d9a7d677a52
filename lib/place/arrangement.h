// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "base/program.h"
#include "base/progress.h"
#include "cover/trace_file.h"
#include "layout/scene.h"
#include "place/arrange_options.h"
#include "place/arranged_sensor.h"
#include "place/curve.h"
#include "place/sensor_group.h"

namespace ispace {

/// Where the sensors stand and what that is worth.
struct Arrangement {
    std::vector<ArrangedSensor> sensors;  ///< by group
    double coverage = 0;  ///< as `coverage` reports coverage.grid for the whole layout
    double area = 0;      ///< total effective area by cells, m2, eq. (4.6)
    /// Share of what counts; not set where that is the coverage.
    std::optional<double> value;
    /// Of `value` or coverage: nothing that the search could choose is worth more or, where sensors
    /// were moved off candidates, no such sensors at any places.
    double bound = 1;
    double candidate_value = 0, candidate_bound = 1;  ///< before refining
    bool is_refined = false;                          ///< somebody asked for it
    std::size_t candidates = 0, bytes = 0;            ///< of all kinds
    Grid grid;                                        ///< the cells while searching
    bool is_complete = true;                          ///< false: cut by time or a signal

    /// Sensors that were to be placed and are not: there are fewer candidates, or none from which
    /// views hang together.
    std::size_t unplaced = 0;
    double cost = 0;         ///< of the sensors placed
    bool has_costs = false;  ///< they differ from 1
    /// With a target: whether it is reached, and that nothing of less cost (fewer sensors, where
    /// costs are equal) reaches it.
    bool is_reached = true;
    std::optional<double> least;
    bool is_exhausted = false;  ///< not reached, and all candidates together are worth no more

    /// Ids of sensors that add nothing to what the others are worth, all of them together.
    std::vector<std::string> idle;

    std::vector<CurvePoint> curve;
    std::vector<TriedPose> tried;
    /// Exact worth, m2; equal where refining found nothing better: then all stand on candidates.
    double refined_before = 0, refined_after = 0;
};

/// Places the groups' sensors beside those that the scene has placed already.
///
/// Candidates by options.strategy, one table per kind of sensor; the target's cells weigh what
/// options.worth says; then search() or minimumCostCover(), then refine(). `mps`: the model is
/// written there before the search. \throws UnmetError if a kind has no valid place or nothing may
/// be bought, UsageError if the
///         candidates do not fit in memory
Arrangement arrange(const Scene& scene, const std::vector<SensorGroup>& groups,
                    const ArrangeOptions& options, Progress& progress, std::ostream* mps = nullptr);

}  // namespace ispace
