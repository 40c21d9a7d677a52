// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/program.h"
#include "sense/depth.h"
#include "sense/scan.h"
#include "sense/ultrasound.h"

namespace ispace {

/// The header line of a stream of readings, with newline.
std::string scanHeaderLine(const History& history, std::uint64_t seed);

/// Appends one scan as a line of JSON: angles in radians, ranges as shortest float32, null for no
/// return. A scan of a sweep has its number as "scan", behind "frame".
void appendScanLine(std::string& out, const Sensor& sensor, const Scan& scan);

/// Appends one picture as a line of JSON: "width", "height", "projection", of a pinhole "fx", "fy",
/// "cx", "cy", of a spherical one "fov" (radians), then what it "measures" (its limits are about
/// that), "range_min", "range_max", "ambiguity" if there is one, and "depths".
void appendDepthLine(std::string& out, const Sensor& sensor, const DepthFrame& frame);

/// Appends one burst as a line of JSON: the tag as "sensor", its true pose, "heard" with
/// "receiver", "time_of_flight" and "range" each, "position" computed, "residual", "pdop", "hdop",
/// "vdop".
void appendBurstLine(std::string& out, const Sensor& tag, const Burst& burst,
                     std::span<const Sensor> receivers);

}  // namespace ispace
