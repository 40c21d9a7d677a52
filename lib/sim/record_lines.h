// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim: the lines of a record.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/sensor_reading.h"
#include "sim/world.h"

namespace ispace {

// The head of a table, and the rows of everybody in it at the world's time.
constexpr std::string_view kRobotsHead =
    "t,id,x,y,heading_deg,speed,rotspeed_deg,accel,rotaccel_deg,stall\n";
void appendRobotRows(std::string& out, const World& world);
constexpr std::string_view kOdometryHead = "t,id,x,y,heading_deg\n";
void appendOdometryRows(std::string& out, const World& world);
constexpr std::string_view kPeopleHead =
    "t,id,x,y,heading_deg,speed,rotspeed_deg,phase,sidespeed,stall\n";
void appendPeopleRows(std::string& out, const World& world);

/// What the sonars of robots measure, in the order of the model, "inf" without an echo; robots
/// without any have no row.
constexpr std::string_view kSonarsHead = "t,id,ranges\n";
void appendSonarRows(std::string& out, World& world);
constexpr std::string_view kBumpersHead = "t,id,hit\n";
/// Rows of the robots whose bumpers feel something else than at the last call with `felt`, which
/// has what each of them felt, empty before.
void appendBumperRows(std::string& out, const World& world, std::vector<std::vector<bool>>& felt);

/// A reading as a line of JSON, as `scan` writes it. A frame that has a file of its own says "file"
/// in place of its pixels.
void appendReadingLine(std::string& out, const RunSensor& sensor, const SensorReading& reading,
                       std::span<const Sensor> receivers, const std::string& file = "");

/// The name of a frame's file: the sensor's id and the number of the period.
std::string frameName(const std::string& id, std::int64_t seq, std::string_view ending = ".png");
/// The frame as PNG: of a ranger 16-bit grey in millimetres, 0 for none. \pre the reading is heavy
std::string frameBytes(const RunSensor& sensor, const SensorReading& reading);

}  // namespace ispace
