// SPDX-License-Identifier: GPL-3.0-or-later
// Hashes of types, as REP 2016 demands.
#pragma once

#include <string>

#include "sense/formats/ros_types.h"

namespace ispace::ros {

/// Computes the hash by which nodes of ROS 2, since Iron, compare their definitions of a type
/// (REP 2016): "RIHS01_" and 64 digits.
std::string rosTypeHash(RosType type);

}  // namespace ispace::ros
