// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "env/mesh.h"
#include "record/schema.h"
#include "sensor/sensor.h"

namespace ispace {

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
