// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scan/options.h"
#include "sense/sensors.h"

namespace ispace {

/// The sensor that takes the poses: that of --model, or the only laser or ranger of the scene,
/// placed or not. It does not see the robot that carries it there. \throws UsageError for a bad
/// --model and where it is not clear which; FormatError as laserOf
Sensors sensorForPoses(const ScanToolOptions& options, const Scene& scene,
                       const DeviceCatalogue& devices);

}  // namespace ispace
