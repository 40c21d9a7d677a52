// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <pugixml.hpp>
#include <string>

#include "geom/pose.h"
#include "sensor/sensor.h"

namespace ispace {

/// Bodies of sensors carry this visibility flag, and cameras mask it out: none sees itself or
/// another.
constexpr std::uint32_t kSensorBodies = 2;

/// Adds the sensor to a link, with the fields of view, samples, ranges, rates and noise that SDF
/// has words for: gpu_lidar for lasers and spherical rangers, depth_camera for other rangers,
/// camera, or wideanglecamera for a fisheye. A sweep is its first scan. Noise that grows with
/// distance is that at half the maximum range, and a camera's that of mid-grey.
/// \return false, with nothing added, for what SDF does not know: ultrasound, tags, mirrors
bool addSdfSensor(pugi::xml_node link, const std::string& name, const SensorModel& model,
                  const Pose3& link_from_sensor);

}  // namespace ispace
