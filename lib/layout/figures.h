// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "env/mesh.h"
#include "layout/robot.h"
#include "layout/scene.h"

namespace ispace {

/// The triangles of what is placed, one mesh a material, in its own frame: x forward, z up, origin
/// at its pose (a sensor's optical centre, on the floor for the others). All are closed and seen
/// from outside only. They are drawn, but stop neither rays nor robots.
///
/// A laser is a small box with a nose where it faces; a ranger and a camera are boxes with lenses;
/// an ultrasonic receiver is a disc across its axis, a tag a ball; a mat is a thin plate; a gate
/// two posts across its heading with a head each at the beam's height; a robot is what sensors see
/// of it, with a nose; a human is figureOfHuman().
std::vector<Mesh> figureOf(const Scene& scene, const Placed& placed);

/// Body of a laser: a box with a nose that shows where it faces. Size of a URG-04LX.
Mesh sensorMesh();

/// Body of a robot, centre of rotation on the floor at the origin: the box or cylinder that sensors
/// see, with a nose.
Mesh robotMesh(const RobotModel& model);

/// A person as in the thesis (fig. 5.10): a ball for the head, boxes for body and arms, legs as
/// upright cylinders, so that a level laser at kScanHeight meets two circles. Facing +x, standing
/// on the floor at the origin; proportions do not change with `height`.
std::vector<Mesh> figureOfHuman(double height);

/// An upright box or cylinder, as part of something that stands on the floor.
struct Upright {
    Point2 center;
    double half_length = 0, half_width = 0;  ///< of a box, along x and y
    double radius = 0;                       ///< of a cylinder; 0: a box
    double bottom = 0, top = 0;
};
/// figureOfHuman() as rays see it: its boxes and cylinders, the head as a cylinder around it.
std::vector<Upright> uprightsOfHuman(double height);

/// What a level laser at kScanHeight meets of a person of that height, in the person's frame.
std::vector<Polygon> legCircles(double height);

/// Radius of the circle about a person of that height that no thing may reach into.
double humanRadius(double height);

}  // namespace ispace
