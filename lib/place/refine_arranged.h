// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only.
#pragma once

#include <cstdint>
#include <vector>

#include "place/refine.h"
#include "place/scene_problem.h"

namespace ispace {

/// refine() of sensors that a search arranged, by the rules of the search: places as its judge has
/// them; on its grid they are worth no less than `least` in the end; where views have to hang
/// together they still do. Sensors that were apart stay so by 5 cm: no two are built in one place.
Refined refineArranged(SceneProblem& model, const std::vector<ArrangedSensor>& sensors,
                       std::uint64_t least, Progress& progress);

/// Sensors at the poses that refining gave them.
std::vector<ArrangedSensor> movedTo(std::vector<ArrangedSensor> sensors,
                                    const std::vector<Pose3>& poses);

}  // namespace ispace
