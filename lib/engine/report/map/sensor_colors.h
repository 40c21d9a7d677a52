// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of sensors, the same in all maps and tables of a report. Deterministic: the order of the
// sensors decides.
//
//     const std::vector<Color> colors = sensorColors(coverage);
//     fill(coverage.sensors[2], colors[2]);
#pragma once

#include <cstddef>
#include <vector>

#include "coverage/coverage.h"
#include "drawing/color.h"

namespace ispace {

/// Returns an index of seriesColor() for each of Coverage::sensors: the first ones take the colours
/// in order, each later one the colour whose nearest sensor is farthest away, so that neighbours
/// differ. Ultrasonic receivers, which cover floor together, share one. O(sensors^2) up to 4000
/// sensors; beyond that, colours repeat in order.
std::vector<std::size_t> sensorHues(const Coverage& coverage);

/// Returns the colours of Coverage::sensors in all pictures of a report.
std::vector<Color> sensorColors(const Coverage& coverage);

}  // namespace ispace
