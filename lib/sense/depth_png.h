// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "sense/depth.h"

namespace ispace {

/// Depths as a 16-bit grey PNG in units of 1 / per_metre (1000: millimetres), rounded. 0 means no
/// return, or a depth that does not fit 16 bits.
std::string depthPng(const Ranger& ranger, const DepthFrame& frame, double per_metre);

/// ROS camera_info as YAML: size and matrices, no distortion. Pixel centres are whole numbers, so
/// cx = (columns - 1) / 2. \pre a pinhole
std::string cameraInfoYaml(const Ranger& ranger, std::string_view name);

}  // namespace ispace
