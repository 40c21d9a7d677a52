// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cover/target.h"
#include "layout/scene.h"
#include "place/sites.h"

namespace ispace {

/// A sensor whose place and heading may still change a little.
struct Movable {
    std::string id;
    SensorModel model;
    Pose3 pose;
    const SiteJudge* judge = nullptr;  ///< of the places it may take; null: all
};

struct RefineOptions {
    int demand = 1;                      ///< floor counts if so many see it
    double plane = 0;                    ///< height of what rangers and receivers cover
    double step = 0.25;                  ///< first step, metres; steps are halved down to 1 mm
    Angle turn = Angle::degrees(11.25);  ///< first turn; likewise down to 0.05 degrees
};

struct Refined {
    std::vector<Pose3> poses;      ///< in the order of the movables
    double before = 0, after = 0;  ///< exact worth covered, m2 times weight; after >= before
    std::size_t evaluations = 0;
};

/// \throws UsageError for what refine() cannot do, before anything is searched: sweeping lasers
/// whose
///         exact region is not known (among `devices` and the scene's), more weights than it knows
void mustBeRefinable(const Scene& scene, std::span<const SensorModel> devices,
                     const FloorWeights& worth);

/// Goes on from a layout in continuous x, y and heading: sensor after sensor, a pattern search
/// (Hooke and Jeeves 1961: steps along the axes and their pattern, halved where none helps) on the
/// exact worth of what at least `demand` sensors see, in closed form (Overlay), with all that
/// stands in the scene (but for what has the id of a movable). A sensor's z, tilt and roll stay,
/// and the heading of one that sees the same at each. Steps lead to whole multiples of 0.1 mm and
/// 0.001 degrees, and count if they gain more than 1e-9 of all there is to cover; a sensor without
/// such a step stays as it was written. Ends when no step of any sensor helps at the least length.
///
/// `accept(poses)` may refuse a step (null: none). The same for any number of threads; ends early,
/// with the best so far, where progress says so.
/// \throws UsageError for sensors, also standing ones, whose exact region is not known (lasers that
///         nod or roll), and for more than 60 weighted zones
Refined refine(const Scene& scene, std::span<const Movable> sensors, const FloorWeights& worth,
               const RefineOptions& options,
               const std::function<bool(const std::vector<Pose3>&)>& accept, Progress& progress);

}  // namespace ispace
