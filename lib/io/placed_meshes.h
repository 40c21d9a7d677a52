// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "env/mesh.h"
#include "layout/robot.h"

namespace ispace {

/// Body of a laser in its own frame, optical centre at the origin: a box with a nose that shows
/// where it faces. Size of a URG-04LX.
Mesh sensorMesh();

/// Body of a robot in its own frame, centre of rotation on the floor at the origin: the box or
/// cylinder that sensors see, with a nose. Closed, seen from outside only.
Mesh robotMesh(const RobotModel& model);

}  // namespace ispace
