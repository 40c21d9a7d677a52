// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/json_writer.h"
#include "geom/pose.h"

namespace ispace {

/// What `pose` is in all JSON: [x, y, z, heading, tilt, roll] in metres and radians. Every digit
/// counts: whoever computes a reading again starts from the same doubles.
void addPose(JsonWriter& json, const Pose3& pose);

}  // namespace ispace
