// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "layout/scene.h"
#include "place/sensor_group.h"

namespace ispace {

/// A sensor at the place found for it.
struct ArrangedSensor {
    std::size_t group = 0;
    std::string id;
    Pose3 pose;
};

/// The places of each kind go to the sensors of its groups, in their order; those for which there
/// is none are left out. New sensors get the next free ids.
std::vector<ArrangedSensor> arrangedSensors(const Scene& scene,
                                            const std::vector<SensorGroup>& groups,
                                            const std::vector<SensorClass>& kinds,
                                            const std::vector<std::vector<Pose3>>& places);

/// The record of a sensor at its place: `id`, `at` with z, `heading` and, where it was chosen,
/// `tilt` set.
Record placedRecord(const SensorGroup& group, const ArrangedSensor& sensor);

/// The scene with the arranged sensors placed.
Scene withArranged(const Scene& scene, const std::vector<SensorGroup>& groups,
                   const std::vector<ArrangedSensor>& sensors);

}  // namespace ispace
