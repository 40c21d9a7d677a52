// SPDX-License-Identifier: GPL-3.0-or-later
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

/// A sensor that still has to be placed.
struct PendingSensor {
    std::string id;
    Record record;
    SensorModel model;
};

/// A placement record that has its place: a sensor, a tag, a mat, a gate, a robot, a person.
struct PlacedRecord {
    std::size_t record = 0;  ///< index in Scene::records
    Pose3 pose;              ///< in the world, where it starts; on the floor but for sensors
    /// Of a sensor in Scene::sensors, of a robot in Scene::robots, of a person in Scene::people.
    std::size_t index = 0;
    std::optional<Mount> mount = {};  ///< of a sensor on a robot
};

/// Environment and layout, joined and resolved: what the tools read.
///
/// A LAYOUT record replaces the ENV record of the same written id, in its place; others follow.
struct Scene {
    std::vector<Record> records;         ///< joined, without `environment` and `result`
    std::vector<std::string> ids;        ///< of each record
    Environment environment;             ///< of the joined records
    std::vector<Sensor> sensors;         ///< with a place, or on what has one, in order
    std::vector<PendingSensor> pending;  ///< those without a place that arrange can place, in order
    std::vector<PlacedRobot> robots;     ///< in order
    std::vector<PlacedPerson> people;    ///< in order
    std::vector<PlacedRecord> placed;    ///< all of them and everything else with a place, in order
    /// digest() where layout or edits changed what it is of; else "".
    std::string digest_of_other = {};

    /// Of ENV alone, see environmentDigest(). Computed when it is first asked for; thread-safe.
    [[nodiscard]] const std::string& digest() const {
        return digest_of_other.empty() ? environment.digest() : digest_of_other;
    }
};

/// The placed sensors whose model is of this type, in order.
template <typename Model>
std::vector<Sensor> sensorsOf(const Scene& scene) {
    std::vector<Sensor> found;
    for (const Sensor& sensor : scene.sensors)
        if (sensor.is<Model>()) found.push_back(sensor);
    return found;
}

/// The records of LAYOUT put in the places of those of ENV with the same written id, the others
/// behind them. \throws FormatError for one of another keyword in the place
std::vector<Record> joinRecords(const std::vector<Record>& environment,
                                const std::vector<Record>& layout);

/// \param before another scene, whose room is shared if none of its records differ; may be null
/// \throws FormatError as Environment does, for unknown models, and for sensors on what carries
///         none
Scene makeScene(const Document& environment, const Document* layout, const DeviceCatalogue& devices,
                const Scene* before = nullptr);

/// The scene of changed records. The room of `before` is shared if none of its records differ; the
/// digest stays. \throws FormatError as above
Scene makeScene(std::vector<Record> records, const Scene& before, const DeviceCatalogue& devices);

/// What a LAYOUT says about its ENV, if it does.
struct EnvironmentReference {
    std::string file;    ///< relative to the LAYOUT's folder; "" if not given
    std::string digest;  ///< "" if not given
    Record record;
};
std::optional<EnvironmentReference> environmentReference(const Document& layout);

/// What a tool does not do yet with a keyword or a key, in one phrase: "`camera` is not simulated
/// yet, left out: c1, c2, c3 and 4 more".
std::string leftOutText(std::string_view name, std::string_view done,
                        const std::vector<std::string>& ids);

/// Such a phrase for each of these keywords that the scene has a record of, with a place or
/// without. \param done what does not become of it: "simulated", "measured" \param is_meant tells
/// of an index in Scene::records whether it counts; all do without it
std::vector<std::string> leftOut(const Scene& scene, std::span<const std::string_view> keywords,
                                 std::string_view done,
                                 const std::function<bool(std::size_t)>& is_meant = {});

/// The edits that a request for a change of a world asks for: `SET ID.KEY=VALUE`, `ADD RECORD`,
/// `DELETE ID…`. \throws UsageError, FormatError as parseEdit, UsageError for another request
std::vector<Edit> parseEdits(std::string_view request);

/// True if an edit is about this id. \pre it does not add
bool isAbout(const Edit& edit, const std::string& id);

/// The key of a record that names a file; null if none does.
const char* fileKeyOf(const Record& record);

/// True if records that these edits are about, or have added, name files. \param scene as they left
/// it
bool touchFiles(const std::vector<Edit>& edits, const Scene& scene);

/// Where robots and people are now, by id; nothing for those who are not known.
using MoverPlaces = std::function<std::optional<Pose2>(const std::string& id)>;

/// The records of a scene after these edits. Robots and people whose place or heading is set are
/// where they are now but for that. \throws FormatError as edited()
std::vector<Record> editedRecords(const Scene& scene, const std::vector<Edit>& edits,
                                  const MoverPlaces& where);

/// Records that editedRecords() made earlier, with robots and people whose place or heading is set
/// where they are now but for that. \param ids of the records
void placeAgain(std::vector<Record>& records, std::span<const std::string> ids,
                const std::vector<Edit>& edits, const MoverPlaces& where);

/// Ids of those whom these edits put somewhere, where they may stand already.
std::vector<std::string> placedBy(const std::vector<Edit>& edits, const Scene& scene);

}  // namespace ispace
