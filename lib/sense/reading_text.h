// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/json_writer.h"
#include "base/program.h"
#include "sense/depth.h"
#include "sense/point_cloud.h"
#include "sense/scan.h"
#include "sense/ultrasound.h"

namespace ispace {

// Readings as lines of text. A reading of any kind has an overload of appendLines() and of
// appendRows(); `receivers` are those that the times of a burst refer to.

// JSON lines: angles in radians, ranges as shortest float32, null for no return.

/// The header line of a stream of readings, with newline.
std::string scanHeaderLine(const History& history, std::uint64_t seed);
/// One scan as a line. A scan of a sweep has its number as "scan", after "frame".
void appendScanLine(std::string& out, const Sensor& sensor, const Scan& scan);
void appendLines(std::string& out, const Sensor& sensor, std::span<const Scan> scans,
                 std::span<const Sensor> receivers = {});
/// One picture: "width", "height", "projection", for a pinhole "fx", "fy", "cx", "cy", for a
/// spherical one "fov", then what it "measures" (which its limits refer to), "range_min",
/// "range_max", "ambiguity" if there is one, and "depths".
void appendLines(std::string& out, const Sensor& sensor, const DepthFrame& frame,
                 std::span<const Sensor> receivers = {});
/// The same with "file", the name of a picture of the depths, in their place.
void appendFileLine(std::string& out, const Sensor& sensor, const DepthFrame& frame,
                    const std::string& file);
/// One burst: the tag as "sensor", its true pose, "heard" with "receiver", "time_of_flight" and
/// "range" each, the computed "position", "residual", "pdop", "hdop", "vdop".
void appendLines(std::string& out, const Sensor& tag, const Burst& burst,
                 std::span<const Sensor> receivers);

/// Appends the key "pose" as all JSON has it: [x, y, z, heading, tilt, roll] in metres and radians,
/// with every digit, so that a reading can be computed again from the same doubles.
void addPose(JsonWriter& json, const Pose3& pose);

// CSV: RFC 4180 with LF; metres, seconds, degrees; an empty field is no return. Numbers are in
// shortest form, bearings, ranges and places as float32; times are rounded to the nanosecond.

/// The header row for readings of sensors like this one.
std::string csvHeader(const Sensor& sensor);
/// A row per beam, polar and Cartesian (thesis fig. 3.24). The sensor's frame is that of the first
/// scan.
void appendRows(std::string& out, const Sensor& sensor, std::span<const Scan> scans, Coordinates in,
                std::span<const Sensor> receivers = {});
/// A row per pixel.
void appendRows(std::string& out, const Sensor& sensor, const DepthFrame& frame, Coordinates in,
                std::span<const Sensor> receivers = {});
/// A row per burst; `times` are RECEIVER=SECONDS separated by blanks. x,y,z is the computed place;
/// the simple model leaves z empty.
void appendRows(std::string& out, const Sensor& tag, const Burst& burst, Coordinates in,
                std::span<const Sensor> receivers);
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
