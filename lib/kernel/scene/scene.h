// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/scene: Scene = environment + layout, the device catalogue, the states of rooms. Uses
// env and below.
//
// A scene is resolved at once: devices give the parameters that records lack, carriers give poses,
// and all poses are in the world at the start. It depends on its records and on the catalogue
// alone. Metres, x-y floor, z up; headings count counter-clockwise from +x.
//
// Doubled ids and elements with unknown models are thrown first; after them the findings about
// placements and about the environment come as one FormatError. A `mesh` record has a body once its
// file is loaded (Record::setMesh()). Scenes are values: several threads may read one, and a change
// builds another, which shares the data of the environment.
//
//     const DeviceCatalogue devices = loadDevices("share/devices");
//     const Document room = readRecordText(readAll("room.env"), "room.env", sceneSchemas());
//     const Scene scene = makeScene(room, nullptr, devices);
//     for (const Sensor& laser : sensorsOf<Laser>(scene)) ids.push_back(laser.id);
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "env/environment.h"
#include "geom/pose.h"
#include "record/edit.h"
#include "record/record.h"
#include "scene/devices.h"
#include "scene/robot.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// A sensor without a position.
struct PendingSensor {
    std::string id;
    Record record;
    SensorModel model;
};

/// A placement record with a pose: a sensor, a tag, a mat, a gate, a robot, a person.
struct PlacedRecord {
    std::size_t record = 0;  ///< index in Scene::records
    Pose3 pose;              ///< in the world, at the start; on the floor except for sensors
    /// Index in Scene::sensors, Scene::robots or Scene::people.
    std::size_t index = 0;
    std::optional<Mount> mount = {};  ///< of a sensor on a robot
};

/// Environment and layout, joined and resolved, as the tools read them.
///
/// A LAYOUT record replaces the ENV record of the same written id in the sequence; others follow.
struct Scene {
    std::vector<Record> records;         ///< joined, without `environment` and `result`
    std::vector<std::string> ids;        ///< of each record
    Environment environment;             ///< of the joined records
    std::vector<Sensor> sensors;         ///< with a pose or a carrier, in order
    std::vector<PendingSensor> pending;  ///< sensors that arrange is to place, in order
    std::vector<PlacedRobot> robots;     ///< in order
    std::vector<PlacedPerson> people;    ///< in order
    std::vector<PlacedRecord> placed;    ///< all of these and all other posed records, in order
    /// The digest() of the environment before layout or edits changed it; else "".
    std::string digest_of_other = {};

    /// Returns the digest of ENV alone, see environmentDigest(). Computed on the first call;
    /// thread-safe.
    [[nodiscard]] const std::string& digest() const {
        return digest_of_other.empty() ? environment.digest() : digest_of_other;
    }
};

/// Returns copies of the placed sensors whose model has this type, in order.
template <typename Model>
std::vector<Sensor> sensorsOf(const Scene& scene) {
    std::vector<Sensor> found;
    for (const Sensor& sensor : scene.sensors)
        if (sensor.is<Model>()) found.push_back(sensor);
    return found;
}

/// Merges LAYOUT into ENV: each record replaces the one with the same written id, the others
/// follow. O(n). \throws FormatError if the replaced record has another keyword
std::vector<Record> joinRecords(const std::vector<Record>& environment,
                                const std::vector<Record>& layout);

/// Builds a scene. \param before another scene, with which the environment shares its data as far
/// as the records are equal; may be null \throws FormatError as Environment does, for unknown
/// models, and for `on` without a valid carrier
Scene makeScene(const Document& environment, const Document* layout, const DeviceCatalogue& devices,
                const Scene* before = nullptr);

/// Builds the scene of changed records. The environment shares its data with that of `before` as
/// far as the records are equal; the digest stays. \throws FormatError as above
Scene makeScene(std::vector<Record> records, const Scene& before, const DeviceCatalogue& devices);

/// The reference of a LAYOUT to its ENV, if any.
struct EnvironmentReference {
    std::string file;    ///< relative to the LAYOUT's folder; "" if not given
    std::string digest;  ///< "" if not given
    Record record;
};
std::optional<EnvironmentReference> environmentReference(const Document& layout);

/// Writes a message about an unsupported keyword or key: "`camera` is not simulated yet, left out:
/// c1, c2, c3 and 4 more".
std::string leftOutText(std::string_view name, std::string_view done,
                        const std::vector<std::string>& ids);

/// Returns such a message for each of these keywords that has records in the scene, posed or not.
/// \param done the missing operation: "simulated", "measured"
/// \param is_meant selects indices in Scene::records; all if unset
std::vector<std::string> leftOut(const Scene& scene, std::span<const std::string_view> keywords,
                                 std::string_view done,
                                 const std::function<bool(std::size_t)>& is_meant = {});

/// Parses a request for edits: `SET ID.KEY=VALUE`, `ADD RECORD`, `DELETE ID…`, `ACT ID KEY=VALUE…`
/// (` ; ` begins another ID). \throws FormatError as parseEdit, UsageError for another request
std::vector<Edit> parseEdits(std::string_view request);

/// Returns true if an edit changes this id. \pre it does not add
bool isAbout(const Edit& edit, const std::string& id);

/// Returns the key of a record that names a file; null without one.
const char* fileKeyOf(const Record& record);

/// Returns true if records that these edits change or add name files. \param scene after the edits,
/// of which one at most adds a record
bool touchFiles(const std::vector<Edit>& edits, const Scene& scene);

/// Returns the current pose of a robot or a person by id; empty for unknown ids.
using MoverPlaces = std::function<std::optional<Pose2>(const std::string& id)>;

/// Returns the records of a scene after these edits. Movers whose position or heading is set keep
/// the other part of their current pose. \throws FormatError as edited()
std::vector<Record> editedRecords(const Scene& scene, const std::vector<Edit>& edits,
                                  const MoverPlaces& where);

/// Updates records that editedRecords() returned earlier to the current poses, by the same rule.
/// \param ids of the records
void placeAgain(std::vector<Record>& records, std::span<const std::string> ids,
                const std::vector<Edit>& edits, const MoverPlaces& where);

/// Returns the ids of the movers whose poses these edits set, even to the current ones.
std::vector<std::string> placedBy(const std::vector<Edit>& edits, const Scene& scene);

}  // namespace ispace
