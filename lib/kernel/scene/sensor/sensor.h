// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/scene/sensor: the kinds of sensors, each a row and a source: keyword, keys,
// parameters, body, field of view. Uses env and below.
//
// The table of kinds is constant once scenes are read; functions of a kind depend on their
// arguments alone and may be called by several threads. The list of core kinds and its rows are
// fixed at compile time, kinds of extensions are added by one thread before that.
//
//     if (const std::optional<FieldOfView> view = fieldOfView(sensor)) reach = view->farthest();
//     if (const Laser* const laser = sensor.tryAs<Laser>()) beams += laser->beams;
#pragma once

#include <any>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <variant>
#include <vector>

#include "env/mesh.h"
#include "geom/pose.h"
#include "record/record.h"
#include "record/schema.h"
#include "scene/sensor/kinds.h"
#include "scene/sensor/shared_list.h"

namespace ispace {

/// The carrier of a moving sensor.
struct Mount {
    std::size_t robot = 0;    ///< index in Scene::robots
    Pose3 robot_from_sensor;  ///< z counts from the floor, as the robot's frame lies there
};

/// A placed sensor; on a robot or a person, in the carrier's starting pose.
struct Sensor {
    std::string id;
    SensorModel model;
    Pose3 pose;
    std::optional<Mount> mount = {};
    std::optional<std::size_t> person = {};  ///< its carrier: index among the scene's people
    /// Length of the room in its id: of "ground/" in a list of the sensors of several rooms.
    std::size_t room = 0;

    /// Returns its id in the scene of its room.
    [[nodiscard]] std::string_view idInRoom() const { return std::string_view(id).substr(room); }
    /// Returns the id of another thing of its room, written as its own: "ground/m2" beside
    /// "ground/m1".
    [[nodiscard]] std::string idBeside(const std::string& other) const {
        return id.substr(0, room) + other;
    }
    template <typename Model>
    [[nodiscard]] bool is() const {
        return tryAs<Model>() != nullptr;
    }
    /// \pre is<Model>()
    template <typename Model>
    [[nodiscard]] const Model& as() const {
        return *tryAs<Model>();
    }
    template <typename Model>
    [[nodiscard]] Model& as() {
        return std::get<Model>(model);
    }
    /// Returns null for another kind.
    template <typename Model>
    [[nodiscard]] const Model* tryAs() const {
        return tryModel<Model>(model);
    }
    /// Returns true if this robot carries it.
    [[nodiscard]] bool isOn(std::size_t robot) const { return mount && mount->robot == robot; }
};

/// Returns the name of the device, "" for a bare sensor.
const std::string& deviceName(const SensorModel& model);
/// Returns the maximum range in metres; +infinity for a tag, 0 on the floor.
double maxRange(const SensorModel& model);
/// Returns the readings a second: of a swept laser, whole sweeps.
double readingRate(const SensorModel& model);
/// Returns the duration of one reading in seconds; 0 if everything is measured at once.
double readingTime(const SensorModel& model);
/// Estimates the rays of one reading, as the cost of its simulation.
std::size_t rayCount(const SensorModel& model);
/// Returns true if its readings have noise, where noise is requested.
bool isNoisy(const SensorModel& model);
/// Returns true if, mounted with this tilt and roll, its view does not depend on its heading.
bool isOmnidirectional(const SensorModel& model, const Pose3& mount);

/// Returns the field of view without occlusion; empty for lasers, which scan a plane, and for tags.
std::optional<FieldOfView> fieldOfView(const Sensor& sensor);

/// Reads the pose of a sensor's record: 0,0 without `at`, kScanHeight without z. With `on` it is a
/// pose in the frame of the carrier.
Pose3 poseOf(const Record& record);

/// Computes the world pose of a sensor on a robot, with its heading in (-180, 180].
Pose3 mountedPose(const Pose2& world_from_robot, const Pose3& robot_from_sensor);

/// A model's row in the device table.
struct DeviceSummary {
    std::string range = "-", field_of_view, size = "-", rate;
};

/// The symbol of a sensor on plans and maps.
enum class SensorSign { Disc, Square, Triangle, Diamond };

/// Errors of one measurement of a point: standard deviations of its distance, metres, and of its
/// direction, radians; 0: not measured.
struct SightErrors {
    double distance = 0, direction = 0;
};

/// The sector that a plan draws for a sensor, in its frame.
struct BearingSpan {
    Angle from, to;
    double range = 0;
};

class DeviceCatalogue;

/// The records of a scene, before they are resolved, their ids, and the devices that they name.
struct RoomRecords {
    std::span<const Record> records;
    std::span<const std::string> ids;
    const DeviceCatalogue& devices;

    /// Returns a list that the sensors of the room share: what find() finds for the first of them.
    template <typename T, typename Find>
    SharedList<T> shared(Find find) const {
        std::any& known = lists[std::type_index(typeid(T))];
        if (!known.has_value()) known = SharedList<T>(find());
        return std::any_cast<SharedList<T>>(known);
    }

    mutable std::map<std::type_index, std::any> lists = {};
};

struct AddedReading;
struct Moment;
class MovingBodies;
struct ReadingKind;

/// One kind of sensor, with all its properties that other folders use: kKind of its parameters,
/// which kinds.h lists, or an extension adds.
struct SensorKind {
    std::string_view keyword;            ///< of its records
    std::string_view noun;               ///< its name in messages
    std::string_view help = {};          ///< of the record
    std::string_view heading_help = {};  ///< of its key `heading`
    std::string_view device_help = {};   ///< of a device file's record; "": there are no devices
    SensorSign sign = SensorSign::Disc;
    /// Keys besides those that all sensors have.
    void (*add_keys)(std::vector<KeySpec>& keys) = nullptr;
    /// Builds its body in its own frame: optical centre at the origin, facing +x.
    std::vector<Mesh> (*body)() = nullptr;

    /// Reads the parameters of a record: its explicit keys, else the device's (if not null), else
    /// those of a bare one. \throws FormatError with all findings
    SensorModel (*read)(const Record& record, const Record* device) = nullptr;
    /// Looks up the records that its readings depend on. Null: none. \throws FormatError
    void (*look_up)(SensorModel& model, const Record& record, const RoomRecords& room) = nullptr;
    /// Removes the things of the room that it looked up, unless they change its view. Null: none.
    void (*forget)(SensorModel& model) = nullptr;
    DeviceSummary (*summary)(const SensorModel& model) = nullptr;
    /// Builds its field of view as a translucent open surface in its frame, two-sided, up to
    /// `reach`. Null: not drawn.
    Mesh (*view)(const Sensor& sensor, double reach) = nullptr;
    BearingSpan (*bearings)(const SensorModel& model) = nullptr;
    /// Null: it scans a plane, or sees no floor.
    FieldOfView (*field_of_view)(const Sensor& sensor) = nullptr;

    /// Surfaces that stop its light or sound.
    Surfaces stopped_by = Surfaces::Opaque;
    bool perceives = true;       ///< sees or hears; false for targets of other sensors
    bool is_read = false;        ///< `scan` takes readings of it, or through it
    bool is_arranged = false;    ///< `arrange` can choose its pose
    bool is_overhead = false;    ///< it hangs above people's heads unless `--mount` says otherwise
    bool follows_poses = false;  ///< `scan --poses` can move it
    bool integrates = false;     ///< a run tells it the mean motion of its carrier: Moment::mean
    /// A point counts as covered if this many of the kind see it.
    std::size_t together = 1;
    /// A tag on a known plane has a position if this many of the kind measure its distance.
    std::size_t locates_together = 1;
    /// Returns the errors of one measurement of a point, by its distance in metres. Null: it
    /// measures no position.
    SightErrors (*sight_errors)(const SensorModel& model, double range) = nullptr;

    /// Returns true if it detects a person in view, by the velocity over the floor in m/s and the
    /// unit vector from the sensor to the person. Null: its readings do not depend on motion.
    bool (*senses)(const SensorModel& model, Vec2 velocity, Vec3 direction) = nullptr;

    /// Returns the pose of a sensor without `at` and `on` by other records, as above its door;
    /// empty without one. Null: no such sensor has a pose. \throws FormatError
    std::optional<Pose3> (*place)(const Record& record, const RoomRecords& room) = nullptr;

    // Of kinds that extensions add; the readings of others are listed in sense/reading.h.
    /// Takes a reading, all at once, see Moment. The surfaces that stop its rays are prepared if it
    /// has rays.
    std::any (*measure)(const Moment& now) = nullptr;
    /// Continues from an earlier reading, of a sensor with memory. Null: it has none.
    void (*follow)(const AddedReading& before, AddedReading& now) = nullptr;
    /// A run takes the reading of each of its periods, also of those that begin and end within a
    /// step: what it remembers depends on all of them. \pre it has `follow`
    bool needs_each_period = false;
    /// Advances what the sensors of the kind share in a run, such as the temperature of their zone,
    /// for one of them to a time in seconds, and returns the reading from which its next one
    /// continues. Null: they share no state. \param memory empty at the start of a run
    /// \pre it has `follow`
    AddedReading (*advance)(const Sensor& sensor, double time, const MovingBodies& bodies,
                            std::any& memory) = nullptr;
    const ReadingKind* reading = nullptr;  ///< the fields, formats and topics of its readings
};

/// Adds a kind, for the program: call it before any scene is read. Its records are placements,
/// which scan reads, run and record as those of other kinds. A second kind of a keyword is ignored.
/// \param kind kKind of its parameters, see AddedSensor; it outlives all scenes
/// \pre if it is read, it has `measure` and `reading`
void addSensorKind(const SensorKind& kind);

/// Returns the kinds of Scene::sensors, in the order in which reports list them: all but those on
/// the floor.
std::span<const SensorKind* const> sensorKinds();
/// Finds the kind of Scene::sensors with this keyword; null for any other. O(kinds)
const SensorKind* sensorKind(std::string_view keyword);
/// Returns the kind of a model.
const SensorKind& kindOf(const SensorModel& model);
/// Returns the rank of its kind in the order in which reports list kinds.
std::size_t kindRank(const SensorModel& model);
/// Returns the keywords of the kinds for which `flag` holds, in the order of the table.
std::vector<std::string_view> keywordsOf(bool SensorKind::*flag);
/// Returns the keywords of the kinds that `is_meant` selects, in the order of the table.
std::vector<std::string> manualKeywords(bool (*is_meant)(const SensorKind& kind));

/// Returns the schemas of all kinds' records and of device files.
std::vector<Schema> sensorSchemas();
std::vector<Schema> sensorDeviceSchemas();
/// Creates the schema of a device file's record: these keys between its model and its source.
Schema deviceSchema(std::string keyword, std::string help, void (*add_keys)(std::vector<KeySpec>&));

}  // namespace ispace
