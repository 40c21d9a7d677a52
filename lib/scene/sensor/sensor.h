// SPDX-License-Identifier: GPL-3.0-or-later
// lib/scene/sensor: the kinds of sensors, each a row and a source: keyword, keys, parameters, body,
// field of view. Uses env and below.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "env/mesh.h"
#include "geom/pose.h"
#include "record/record.h"
#include "record/schema.h"
#include "scene/sensor/camera.h"
#include "scene/sensor/laser.h"
#include "scene/sensor/ranger.h"
#include "scene/sensor/ultrasound.h"

namespace ispace {

/// Parameters of a sensor of any simulated kind. Code tells kinds apart here, in their own sources
/// and where readings differ by nature, nowhere else.
using SensorModel = std::variant<Laser, Ranger, Receiver, Tag, Camera>;

/// What carries a sensor that moves.
struct Mount {
    std::size_t robot = 0;    ///< index in Scene::robots
    Pose3 robot_from_sensor;  ///< z counts from the floor, as the robot's frame lies there
};

/// A placed sensor; one on a robot or a person is where that starts.
struct Sensor {
    std::string id;
    SensorModel model;
    Pose3 pose;
    std::optional<Mount> mount = {};
    std::optional<std::size_t> person = {};  ///< who carries it: index among the scene's people

    template <typename Model>
    [[nodiscard]] bool is() const {
        return std::holds_alternative<Model>(model);
    }
    /// \pre is<Model>()
    template <typename Model>
    [[nodiscard]] const Model& as() const {
        return std::get<Model>(model);
    }
    template <typename Model>
    [[nodiscard]] Model& as() {
        return std::get<Model>(model);
    }
};

/// Name of the device, "" for a bare sensor.
const std::string& deviceName(const SensorModel& model);
/// Greatest distance at which it sees or hears, metres; +infinity for a tag.
double maxRange(const SensorModel& model);
/// Readings a second: of a swept laser, whole sweeps.
double readingRate(const SensorModel& model);
/// Duration of one reading in seconds; 0 if everything is measured at once.
double readingTime(const SensorModel& model);
/// Rays of one reading, roughly: what it costs to simulate.
std::size_t rayCount(const SensorModel& model);
/// True if, mounted with this tilt and roll, it sees the same whatever its heading.
bool isOmnidirectional(const SensorModel& model, const Pose3& mount);

/// What it perceives if nothing is in the way; nothing for lasers, which scan a plane, and for
/// tags.
std::optional<FieldOfView> fieldOfView(const Sensor& sensor);

/// The pose that a sensor's record gives: 0,0 without `at`, kScanHeight without z. With `on` it is
/// a pose in the frame of the carrier.
Pose3 poseOf(const Record& record);

/// World pose of a sensor on a robot, with its heading in (-180, 180].
Pose3 mountedPose(const Pose2& world_from_robot, const Pose3& robot_from_sensor);

/// A model's row in the device table.
struct DeviceSummary {
    std::string range = "-", field_of_view, size = "-", rate;
};

/// The symbol of a sensor on plans and maps.
enum class SensorSign { Disc, Square, Triangle, Diamond };

/// The sector that a plan draws for a sensor, in its frame.
struct BearingSpan {
    Angle from, to;
    double range = 0;
};

/// One kind of sensor: everything the other folders ask about it. A new kind is a source with such
/// a row, listed in sensorKinds(), and an alternative of SensorModel.
struct SensorKind {
    std::string_view keyword;       ///< of its records
    std::string_view noun;          ///< what people call one
    std::string_view help;          ///< of the record
    std::string_view heading_help;  ///< of its key `heading`
    std::string_view device_help;   ///< of a device file's record; "": there are no devices
    SensorSign sign = SensorSign::Disc;
    /// Keys besides those that all sensors have.
    void (*add_keys)(std::vector<KeySpec>& keys);
    /// Its body in its own frame: optical centre at the origin, facing +x.
    std::vector<Mesh> (*body)();

    /// The parameters of a record: its explicit keys, else the device's (if not null), else those
    /// of a bare one. \throws FormatError with all findings
    SensorModel (*read)(const Record& record, const Record* device) = nullptr;
    DeviceSummary (*summary)(const SensorModel& model) = nullptr;
    /// Its field of view as a translucent open surface in its frame, two-sided, up to `reach`.
    /// Null: none.
    Mesh (*view)(const Sensor& sensor, double reach) = nullptr;
    BearingSpan (*bearings)(const SensorModel& model) = nullptr;

    /// Surfaces that stop its light or sound.
    Surfaces stopped_by = Surfaces::Opaque;
    bool perceives = true;       ///< sees or hears; false for what others look for
    bool is_read = false;        ///< `scan` takes readings of it, or through it
    bool is_arranged = false;    ///< `arrange` can place it
    bool is_overhead = false;    ///< it hangs above people's heads unless `--mount` says otherwise
    bool follows_poses = false;  ///< `scan --poses` can move it
    /// A place counts as covered if this many of the kind see it.
    std::size_t together = 1;
};

/// All kinds, in the order in which reports list them.
std::span<const SensorKind* const> sensorKinds();
/// The kind with this keyword, or null.
const SensorKind* sensorKind(std::string_view keyword);
/// \pre the model is of a kind, as all are
const SensorKind& kindOf(const SensorModel& model);
/// Keywords of the kinds for which `flag` holds, in the order of the table.
std::vector<std::string_view> keywordsOf(bool SensorKind::*flag);

/// Records of all kinds, and those of device files.
std::vector<Schema> sensorSchemas();
std::vector<Schema> sensorDeviceSchemas();
/// The schema of a device file's record: these keys between what it is and who says so.
Schema deviceSchema(std::string keyword, std::string help, void (*add_keys)(std::vector<KeySpec>&));

}  // namespace ispace
