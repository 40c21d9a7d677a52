// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors to be placed, from their records to their poses.
//
// A group is one record, of the layout or of --sensor, with a count. Groups with equal parameters
// and mount are one class (kindsOf): they share candidates. A search chooses poses by class, and
// placementsOf() deals them out to the sensors of the groups, in order. All of it depends on the
// order of records and options alone.
//
//     const auto groups = groupsToPlace(scene, specs, devices, false);
//     const auto kinds = kindsOf(groups);
//     const auto placed = placementsOf(rooms, groups, kinds, poses);
//     const Record record = placedRecord(groups[placed[0].group], placed[0]);
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor_spec.h"

namespace ispace {

/// Maximum size of a group if the search finds its number of sensors.
constexpr int kMaxOpen = 1000;

/// Equal sensors to be placed: an unplaced sensor of the scene, or those of one --sensor.
struct SensorGroup {
    Record record;  ///< without a pose
    SensorModel model;
    std::string id;           ///< empty: the next free ids of its keyword
    bool is_pending = false;  ///< of the scene; else new
    int most = 1;
    /// The model before objectives limit the floor that it covers; empty: the same.
    std::optional<SensorModel> whole = {};
    std::optional<std::size_t> room = {};  ///< of several rooms, the one that it stands in
};

/// Scenes of the rooms of a site; null for those that are left out.
using RoomScenes = std::span<const Scene* const>;

/// Returns all sensors to be placed: the unplaced ones of the rooms, each to stand in its room,
/// then `added`, which may stand in any. `open`: the search finds the number of added sensors
/// without a count, up to kMaxOpen.
/// \throws UsageError if an added record has a pose or an id that is taken, FormatError as
///         withParameters()
std::vector<SensorGroup> groupsToPlace(RoomScenes rooms, std::span<const SensorSpec> added,
                                       const DeviceCatalogue& devices, bool open);
/// As above, for a room alone.
std::vector<SensorGroup> groupsToPlace(const Scene& scene, std::span<const SensorSpec> added,
                                       const DeviceCatalogue& devices, bool open);

/// Returns the layout with the poses of its sensors removed, so that they are placed anew, except
/// sensors that match one of the globs and those mounted on a mover.
/// \throws UsageError for a glob that matches no placed sensor
Document withoutPlaces(const Document& layout, std::span<const std::string> fixed);

/// Sensors that share their candidates: equal parameters and mount.
struct SensorClass {
    SensorModel model;
    Record record;   ///< of the first sensor
    std::string id;  ///< for messages and as a seed of its random sites
    double cost = 1;
    int most = 0;                           ///< over all its groups
    std::vector<std::size_t> groups = {};   ///< ascending
    std::optional<SensorModel> whole = {};  ///< of its groups
    std::optional<std::size_t> room = {};   ///< of its groups
};

/// Returns the kinds of these groups, in order of first appearance; `apart`: one for each sensor.
/// Groups with different costs, rooms, tilts or rolls are different kinds. O(groups * kinds)
std::vector<SensorClass> kindsOf(const std::vector<SensorGroup>& groups, bool apart = false);

/// A sensor and the pose found for it, if any.
struct Placement {
    std::size_t group = 0, kind = 0;
    std::string sensor = {};  ///< id, in its room
    Pose3 pose = {};
    std::size_t room = 0;  ///< of the site; the pose is in its frame
};

/// A pose in a room of a site.
struct RoomPose {
    std::size_t room = 0;
    Pose3 pose = {};
};

/// Returns every sensor to be placed, group after group; id and pose are empty.
std::vector<Placement> sensorsToPlace(const std::vector<SensorGroup>& groups,
                                      const std::vector<SensorClass>& kinds);

/// Returns true for sensors that cover floor only together with others: receivers.
inline bool isPartial(const SensorModel& model) { return kindOf(model).together > 1; }

/// Assigns the poses of each kind to the sensors of its groups, in order; removes sensors without a
/// pose. New sensors get the next free ids of their rooms, in the order of the groups; pending ones
/// keep theirs.
std::vector<Placement> placementsOf(RoomScenes rooms, const std::vector<SensorGroup>& groups,
                                    const std::vector<SensorClass>& kinds,
                                    const std::vector<std::vector<RoomPose>>& poses);

/// Returns the sensor of a placement.
Sensor sensorOf(const std::vector<SensorGroup>& groups, const Placement& placement);

/// Returns the record of a placed sensor: `id`, `at` with z, `heading` and, if the search chose it,
/// `tilt` are set.
Record placedRecord(const SensorGroup& group, const Placement& placement);

/// Returns the scene of a room with those of these sensors placed that stand in it, after its own.
/// Its records stay as they are: digests and layouts do not know the new sensors.
Scene withPlaced(const Scene& scene, const std::vector<SensorGroup>& groups,
                 const std::vector<Placement>& placements, std::size_t room = 0);

}  // namespace ispace
