// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/server: readings as the protocol has them, see ispace-protocol(7).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "sim/sensor_reading.h"

namespace ispace {

/// What the bytes of a depth frame or a picture are.
enum class FrameFormat {
    None,     ///< the sensor has no bytes, or only one kind of them
    Png,      ///< a file; of depths 16-bit grey, millimetres, 0 for none
    Jpeg,     ///< a file
    Rgb,      ///< a byte for each colour of each pixel
    Depth32,  ///< float32 a pixel as the device measures, +infinity for none
    Depth16,  ///< uint16 a pixel, millimetres, 0 for none
    Cloud     ///< float32 x, y, z a pixel in the sensor's frame, NaN for none
};

/// How a reading is put into a line, and bytes behind it.
struct ReplyForm {
    bool stream = false;  ///< sent unasked
    bool binary = false;  ///< bytes behind the line; else all is in the line
    FrameFormat format = FrameFormat::None;
    friend bool operator==(const ReplyForm&, const ReplyForm&) = default;
};

/// The formats of a sensor, the default first; none if there is no choice.
std::span<const FrameFormat> formatsOf(const RunSensor& sensor);
std::string_view nameOf(FrameFormat format);
/// True if its readings can be bytes behind a line.
bool hasBytes(const RunSensor& sensor);
/// What a client is told of a laser: " angle_min=… rate=10".
std::string laserFigures(const Laser& laser);
/// Of any sensor: " kind=camera width=… rate=30".
std::string sensorFigures(const RunSensor& sensor);

/// A range as replies have it: three decimals as formatFixed writes them, `-` for no return.
void appendRange(std::string& out, float range);

/// A reading as a SCAN line with its newline, and bytes behind it. A laser's binary line has
/// bytes=N in place of r=, and N bytes of little-endian float32 follow, +inf for no return; a
/// frame's has base64= in place of bytes= if it is not binary. \throws FormatError for a JPEG where
/// OpenCV's imgcodecs cannot be opened
std::string scanText(const RunSensor& sensor, const SensorReading& reading, const ReplyForm& form);

}  // namespace ispace
