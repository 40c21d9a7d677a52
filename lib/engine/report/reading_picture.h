// SPDX-License-Identifier: GPL-3.0-or-later
// Readings as PNG pictures for people. Equal input gives equal bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "sense/depth.h"
#include "sense/formats/reading_format.h"
#include "sense/scan.h"

namespace ispace {

/// The two pictures below, for FormatOptions.
const ReadingDrawings& readingDrawings();

/// Draws depths in colours, with a legend: near is warm, far is cold, no return is black. Without a
/// spectrum, the scale spans the ranger's limits (of an ambiguous one: 0 to its ambiguity), so that
/// pictures of one device are comparable.
std::string colorDepthPng(const Sensor& sensor, const DepthFrame& frame,
                          std::optional<DepthSpectrum> spectrum = std::nullopt);

/// Draws the returns of a scan as points on a polar grid (thesis fig. 3.24): the sensor at the
/// centre, bearing 0 upwards, labelled rings at round distances, a spoke every 30 degrees, the
/// field of view shaded up to max_range. `pixels` wide and high.
std::string obstacleMapPng(const Sensor& sensor, const Scan& scan, int pixels);

/// Returns `id (model), frame k`, followed by tilt and roll unless they are 0.
std::string pictureTitle(std::string_view id, std::string_view model, std::string_view kind,
                         int frame, const Pose3& pose);
/// Formats a round number of metres with its unit: "0.25 m".
std::string metres(double value);
/// Formats to a tenth of a degree, with a typographic minus sign: "−7.5°".
std::string degrees(Angle angle);

}  // namespace ispace
