// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "sense/scan.h"
#include "sensor/sensor.h"

namespace ispace {

/// What a scan met, as points about the sensor on a polar grid (thesis fig. 3.24): the sensor in
/// the middle, bearing 0 upwards, rings at round distances with their labels, spokes each 30
/// degrees, the field of view shaded up to max_range. PNG, `pixels` wide and high; equal input
/// gives equal bytes.
std::string obstacleMapPng(const Sensor& sensor, const Scan& scan, int pixels);

}  // namespace ispace
