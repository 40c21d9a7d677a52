// SPDX-License-Identifier: GPL-3.0-or-later
// Formats readings for the protocol, see ispace-protocol(7). For lib/engine/server and its bridges.
//
//     SCAN l1 t=0.250 seq=1 r=1.234,-,2.000
//
// Lines hold metres, degrees and seconds; times, ranges and measured values have three decimals,
// other numbers as many as they need. Bytes after a line are as FrameFormat says, those of a laser
// its ranges as float32. The text depends on the reading and the form alone, so all readers of a
// reading share it. Pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "sim/sensor_reading.h"

namespace ispace {

/// Encoding of a depth frame or a picture.
enum class FrameFormat {
    None,     ///< the sensor sends no bytes, or has only one encoding
    Png,      ///< a file; depths: 16-bit grey, millimetres, 0 for no return
    Jpeg,     ///< a file
    Rgb,      ///< one byte per colour of each pixel
    Depth32,  ///< float32 per pixel along the axis (spherical: the ray), +infinity for no return
    Depth16,  ///< uint16 per pixel, millimetres, 0 for no return
    Cloud     ///< float32 x, y, z per pixel in the sensor's frame, NaN for no return
};

/// Form of a reading: a line, optionally followed by bytes.
struct ReplyForm {
    bool stream = false;  ///< sent without a request
    bool binary = false;  ///< bytes follow the line; otherwise the line holds all data
    FrameFormat format = FrameFormat::None;
    friend bool operator==(const ReplyForm&, const ReplyForm&) = default;
};

/// Encodings that a sensor supports, the default first; empty if there is no choice: only cameras
/// and depth cameras have one.
std::span<const FrameFormat> formatsOf(const Sensor& sensor);
std::string_view nameOf(FrameFormat format);
/// True if the sensor's readings can be sent as bytes after a line.
bool hasBytes(const Sensor& sensor);
/// Describes a sensor to clients, without its kind: " angle_min=… rate=10".
std::string figuresOf(const Sensor& sensor);

/// Appends a range: three decimals as formatFixed writes them, `-` for no return.
void appendRange(std::string& out, float range);

/// Converts a reading to a SCAN line with its newline and the bytes after it. A laser's binary line
/// has bytes=N instead of r=, and N bytes of little-endian float32 follow, +inf for no return; a
/// frame that is not binary has base64= instead of bytes=. \throws FormatError for a JPEG if
/// OpenCV's imgcodecs cannot be loaded
std::string scanText(const Sensor& sensor, const SensorReading& reading, const ReplyForm& form);

}  // namespace ispace
