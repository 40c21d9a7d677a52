// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cover/sight.h"
#include "cover/target.h"
#include "layout/scene.h"
#include "place/sensor_group.h"

namespace ispace {

class SceneProblem;

struct RefineOptions {
    int multiplicity = 1;                ///< floor is covered if this many see it
    double step = 0.25;                  ///< first step, metres; steps are halved down to 1 mm
    Angle turn = Angle::degrees(11.25);  ///< first turn; likewise down to 0.05 degrees
    /// Refuses places of a sensor, by its index; null: takes all.
    std::function<bool(std::size_t, Point2)> is_valid = {};
    /// Refuses steps, by the poses of all sensors after it; null: takes all.
    std::function<bool(const std::vector<Pose3>&)> accepts = {};
};

struct Refined {
    std::vector<Pose3> poses;      ///< in the order of the sensors
    double before = 0, after = 0;  ///< exact weighted area covered, m2; after >= before
    std::size_t evaluations = 0;
};

/// Checks before a search that refine() can follow it. \throws UsageError for sweeping lasers whose
/// exact region is not known (among `devices` and the scene's) and for too many weights
void mustBeRefinable(const Scene& scene, std::span<const SensorModel> devices,
                     const FloorWeights& weights);

/// Improves a layout in continuous x, y and heading: sensor after sensor, by pattern search (Hooke
/// and Jeeves 1961: steps along the axes and their pattern, halved where none helps). The objective
/// is the exact weighted area that at least `multiplicity` sensors see, in closed form (Overlay),
/// including all that stands in the scene. z, tilt and
/// roll stay, and so does the heading of a sensor that sees the same at every heading. Steps lead
/// to whole multiples of 0.1 mm and 0.001 degrees and count if they gain more than 1e-9 of the
/// total; a sensor without such a step keeps its pose to the bit. Ends when no step of the smallest
/// length helps.
///
/// The result does not depend on the number of threads; ends early, with the best so far, if
/// progress says stop.
/// \param sight of the scene's environment
/// \throws UsageError for sensors, also standing ones, whose exact region is not known (lasers that
///         nod or roll), and for more than 60 weighted zones
Refined refine(const Scene& scene, const Sight& sight, std::span<const Sensor> sensors,
               const FloorWeights& weights, const RefineOptions& options, Progress& progress);

/// refine() for sensors that a search arranged, by the rules of the search: places stay valid, the
/// value on its grid ends no lower than `least`, and connected coverage stays connected. Sensors
/// that were apart stay 5 cm apart: no two are built in one place.
Refined refine(SceneProblem& model, const std::vector<Placement>& placements, std::uint64_t least,
               Progress& progress);

}  // namespace ispace
