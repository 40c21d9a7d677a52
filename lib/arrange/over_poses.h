// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "arrange/arrange.h"
#include "arrange/sensor_group.h"
#include "base/error.h"
#include "scene/scene.h"

namespace ispace {

/// Finds the fewest lasers that see the whole free floor at their height, over all poses, with a
/// proof (ArrangeOptions::over_poses).
/// \throws UsageError unless it is an art gallery: lasers of one kind that turn all around, level,
///         with a range beyond the room; straight walls; all of the floor as target
Arrangement arrangeOverPoses(const Scene& scene, const std::vector<SensorGroup>& groups,
                             const ArrangeOptions& options, Progress& progress);

}  // namespace ispace
