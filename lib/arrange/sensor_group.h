// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// Maximum size of a group whose number the search finds.
constexpr int kMaxOpen = 1000;

/// Like sensors to be placed: one of the scene without a place, or those of one --sensor.
struct SensorGroup {
    Record record;  ///< without place
    SensorModel model;
    std::string id;           ///< empty: the next free ones of its keyword
    bool is_pending = false;  ///< of the scene; else new
    int most = 1;
};

/// All sensors to be placed: those of the scene without a place, then `added`. `open`: the search
/// finds the number of added ones without a count, up to kMaxOpen.
/// \throws UsageError if an added record has a place or an id that is taken, FormatError as laserOf
std::vector<SensorGroup> groupsToPlace(const Scene& scene, std::span<const SensorSpec> added,
                                       const DeviceCatalogue& devices, bool open);

/// The layout without the places of its sensors, so that they are placed anew, except those that
/// match one of the globs and those mounted on something that moves.
/// \throws UsageError for a glob that matches no sensor with a place
Document withoutPlaces(const Document& layout, std::span<const std::string> fixed);

/// Sensors that choose from the same candidates: equal parameters, mounted alike.
struct SensorClass {
    SensorModel model;
    Record record;   ///< of the first of them
    std::string id;  ///< for messages and as a seed of its random places
    double cost = 1;
    int most = 0;                          ///< of all its groups
    std::vector<std::size_t> groups = {};  ///< in their order
};

/// The kinds of these groups, in order of first appearance; `apart`: one for each sensor.
std::vector<SensorClass> kindsOf(const std::vector<SensorGroup>& groups, bool apart = false);

/// A sensor at the pose found for it, or still without one.
struct Placement {
    std::size_t group = 0, kind = 0;
    std::string sensor = {};  ///< id
    Pose3 pose = {};
};

/// Every sensor to be placed, group after group; id and pose are left out.
std::vector<Placement> sensorsToPlace(const std::vector<SensorGroup>& groups,
                                      const std::vector<SensorClass>& kinds);

/// True for sensors that cover floor only together with others: receivers.
inline bool isPartial(const SensorModel& model) { return kindOf(model).together > 1; }

/// Assigns the poses of each kind to the sensors of its groups, in order; sensors for which none is
/// left are dropped. New sensors get the next free ids.
std::vector<Placement> placementsOf(const Scene& scene, const std::vector<SensorGroup>& groups,
                                    const std::vector<SensorClass>& kinds,
                                    const std::vector<std::vector<Pose3>>& poses);

/// The sensor of a placement.
Sensor sensorOf(const std::vector<SensorGroup>& groups, const Placement& placement);

/// The record of a placed sensor: `id`, `at` with z, `heading` and, if the search chose it, `tilt`
/// are set.
Record placedRecord(const SensorGroup& group, const Placement& placement);

/// The scene with these sensors placed.
Scene withPlaced(const Scene& scene, const std::vector<SensorGroup>& groups,
                 const std::vector<Placement>& placements);

}  // namespace ispace
