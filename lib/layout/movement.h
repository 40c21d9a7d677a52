// SPDX-License-Identifier: GPL-3.0-or-later
// How limbs of people, and sensors that robots and people carry, follow their movement.
#pragma once

#include "geom/pose.h"

namespace ispace {

/// Share of kMaxSwingDegrees by which a person's limbs swing at a speed, m/s: 1 from half a metre a
/// second on.
double shareOfSwing(double speed);

/// Angle of a walking person's left leg ahead of the hip, as humanParts() takes it. \param phase
/// share of the stride in [0, 1); the left leg is ahead in its first half \param speed m/s
Angle limbSwing(double phase, double speed);

/// A pose in the frame of a carrier on the floor: mountedPose() undone.
Pose3 poseOn(const Pose2& carrier, const Pose3& pose);

}  // namespace ispace
