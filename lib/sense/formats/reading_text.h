// SPDX-License-Identifier: GPL-3.0-or-later
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

/// The header line of a stream of readings, with newline.
std::string scanHeaderLine(const History& history, std::uint64_t seed);
/// One reading as a line: "sensor", "t", "frame", of a sweep's scan its number as "scan", "pose",
/// the fields of its kind. A frame with a `file` has the name in "file" in place of its pixels.
void appendLine(std::string& out, const ReadingView& reading, const std::string& file = "");

/// Appends the key "pose" as all JSON has it: [x, y, z, heading, tilt, roll] in metres and radians,
/// with every digit, so that a reading can be computed again from the same doubles.
void addPose(JsonWriter& json, const Pose3& pose);

// CSV: RFC 4180 with LF; metres, seconds, degrees; an empty field is no return. Numbers are in
// shortest form, bearings, ranges and places as float32; times are rounded to the nanosecond.

/// The header row for readings of sensors like this one.
std::string csvHeader(const Sensor& sensor);
/// A row per beam (polar and Cartesian, thesis fig. 3.24), per pixel, or per burst: `times` are
/// RECEIVER=SECONDS separated by blanks, x,y,z is the computed position. The sensor's frame is that
/// of the first scan.
void appendRows(std::string& out, const Sensor& sensor, const Reading& reading, Coordinates in,
                std::span<const Sensor> receivers = {});
/// A field, in quotes if it needs them.
void appendCsvField(std::string& out, std::string_view text);

// CARMEN logs.

/// Comment lines that tell a reader how to understand the log.
std::string carmenHeader();
/// One message of the laser with this number (ROBOTLASER1, ...) in the newer dialect, with the
/// number of remissions, 0. Metres and radians; no return is max_range. `robot` is the pose of its
/// carrier, or that of the sensor if nothing carries it. \pre the sensor is level
void appendCarmenLine(std::string& out, std::size_t number, const Sensor& sensor, const Scan& scan,
                      const Pose2& robot);

}  // namespace ispace
