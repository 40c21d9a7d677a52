// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

#include "sense/scan.h"
#include "sensor/sensor.h"

namespace ispace {

/// Lines before the first message: how a reader should understand the log.
std::string carmenHeader();

/// Appends one message of the `number`th laser, ROBOTLASER1 and so on, of the newer dialect (with
/// the number of remissions, 0), in metres and radians; no return is max_range. `robot` is where
/// its carrier stands; that of a sensor that stands still is the sensor's own place. \pre the
/// sensor is level
void appendCarmenLine(std::string& out, std::size_t number, const Sensor& sensor, const Scan& scan,
                      const Pose2& robot);

}  // namespace ispace
