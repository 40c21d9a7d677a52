// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "sense/depth.h"
#include "sensor/sensor.h"

namespace ispace {

/// Depths as a 16-bit grey PNG: units of 1 / per_metre (1000: millimetres), rounded; 0 is no
/// return, and so is what does not fit 16 bits.
std::string depthPng(const Ranger& ranger, const DepthFrame& frame, double per_metre);

/// The same in colours for people, with a legend: near is warm, far is cold, no return is black.
/// The scale goes from the ranger's least to its greatest range (of an ambiguous one: 0 to that),
/// so that pictures of one device compare. PNG; equal input gives equal bytes.
std::string colorDepthPng(const Sensor& sensor, const DepthFrame& frame);

/// camera_info of ROS as YAML: size, matrices, no distortion; pixel centres are whole numbers, so
/// cx = (columns - 1) / 2. \pre a pinhole
std::string cameraInfoYaml(const Ranger& ranger, std::string_view name);

}  // namespace ispace
