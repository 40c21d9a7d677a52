// SPDX-License-Identifier: GPL-3.0-or-later
// Text of readings: JSON lines (RFC 8259), CSV (RFC 4180) and the logs of CARMEN (M. Montemerlo, N.
// Roy, S. Thrun, Perspectives on standardization in mobile robot programming: the Carnegie Mellon
// Navigation (CARMEN) toolkit, 2003). Functions append to a string and keep no state: thread-safe,
// independent of the locale.
//
//     std::string out = scanHeaderLine(history, seed);
//     for (const ReadingView& view : viewsOf(sensor, reading)) appendLine(out, view);
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/json_writer.h"
#include "base/message.h"
#include "sense/formats/point_cloud.h"
#include "sense/formats/reading_fields.h"

namespace ispace {

// Readings as lines of text, with the fields of the table.

// JSON lines: angles in radians, ranges as shortest float32, null for no return.

/// Returns the header line of a stream of readings, with newline.
std::string scanHeaderLine(const History& history, std::uint64_t seed);
/// Appends a reading as a line: "sensor", "t", "frame", for a sweep's scan its number as "scan",
/// "pose", and the fields of its kind. If `file` is set, "file" replaces the pixels of a frame.
void appendLine(std::string& out, const ReadingView& reading, const std::string& file = "");

/// Returns one JSON field of a reading, as in appendLine(). \pre its kind has that field
std::string jsonOfField(const ReadingView& reading, std::string_view name);

/// Appends the key "pose" as in all JSON: [x, y, z, heading, tilt, roll] in metres and radians,
/// with all digits, so that a reading can be recomputed from the same doubles.
void addPose(JsonWriter& json, const Pose3& pose);

// CSV: RFC 4180 with LF; metres, seconds, degrees; an empty field is no return. Numbers are in
// shortest form, bearings, ranges and positions as float32; times are rounded to the nanosecond.

/// Returns the header row for readings of sensors like this one.
std::string csvHeader(const Sensor& sensor);
/// Appends a row per beam (polar and Cartesian, thesis fig. 3.24), per pixel, or per burst: `times`
/// are RECEIVER=SECONDS separated by blanks, x,y,z is the computed position. The sensor's frame is
/// that of the first scan.
void appendRows(std::string& out, const Sensor& sensor, const Reading& reading, Coordinates in,
                std::span<const Sensor> receivers = {});
/// Appends a field, quoted if necessary.
void appendCsvField(std::string& out, std::string_view text);

// CARMEN logs.

/// Returns comment lines that explain the log.
std::string carmenHeader();
/// Appends a message of the laser with this number (ROBOTLASER1, ...) in the newer dialect, with
/// the number of remissions, 0. Metres and radians; no return is max_range. `robot` is the pose of
/// its carrier, or that of the sensor without a carrier. \pre the sensor is level
void appendCarmenLine(std::string& out, std::size_t number, const Sensor& sensor, const Scan& scan,
                      const Pose2& robot);

}  // namespace ispace
