// SPDX-License-Identifier: GPL-3.0-or-later
// Poses of sensors on people and on joints, for scenes. Metres; sensors keep their poses in the
// frame of the carrier, and move with it.
#pragma once

#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

/// Reads the pose of a sensor in the frame of the person who carries it: without a written height
/// it is at the eyes. The figure of a person that sits or lies moves it with the trunk, and its
/// directions stay.
Pose3 poseOnPerson(const Record& sensor, const Record& person);

/// Computes the pose of a sensor on a carrier with any rotation. One that is level on a level
/// carrier is so exactly.
Pose3 poseOnJoint(const Pose3& world_from_carrier, const Pose3& carrier_from_sensor);

}  // namespace ispace
