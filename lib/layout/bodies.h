// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "env/mesh.h"
#include "layout/robot.h"
#include "layout/scene.h"

namespace ispace {

/// The triangles of what is placed, one mesh a material, in its own frame: x forward, z up, origin
/// at its pose (a sensor's optical centre, on the floor for the others). All are closed and seen
/// from outside only. They are drawn, but stop neither rays nor robots.
///
/// A sensor's is that of its kind; a mat is a thin plate; a gate two posts across its heading with
/// a head each at the beam's height; a robot is what sensors see of it, with a nose; a human is
/// humanBodyOf().
std::vector<Mesh> bodyOf(const Scene& scene, const Placed& placed);

/// What a placed sensor looks at, as a translucent sheet in its frame, see SensorKind::view; no
/// farther than the plan is wide, so that a model stays in scale. Nothing for everything else.
std::optional<Mesh> viewOf(const Scene& scene, const Placed& placed);

/// Body of a robot, centre of rotation on the floor at the origin: the box or cylinder that sensors
/// see, with a nose.
Mesh robotMesh(const RobotModel& model);

/// A person as in the thesis (fig. 5.10): a ball for the head, boxes for body and arms, legs as
/// upright cylinders, so that a level laser at kScanHeight meets two circles. Facing +x, standing
/// on the floor at the origin; proportions do not change with `height`.
///
/// Walking, the left leg is ahead of the hip by the angle `swing` and the right one behind it; arms
/// swing the other way. Limbs are sheared, not turned: a level cut keeps its shape and the feet
/// stay on the floor.
std::vector<Mesh> humanBodyOf(double height, Angle swing = {});

/// How far limbs swing at most (thesis 5.3.1), and how long a stride, two steps, is with that: the
/// feet stay where they are put down.
constexpr double kMaxSwingDegrees = 15;
double strideOf(double height);

/// An upright box or cylinder, as part of something that stands on the floor.
struct Upright {
    Point2 center;
    double half_length = 0, half_width = 0;  ///< of a box, along x and y
    double radius = 0;                       ///< of a cylinder; 0: a box
    double bottom = 0, top = 0;
};
/// humanBodyOf() as rays see it: its boxes and cylinders, the head as a cylinder around it. Limbs
/// that swing are piles of a few pieces, the lowest of a leg with its middle at kScanHeight.
std::vector<Upright> humanUprights(double height, Angle swing = {});

/// What a level laser at kScanHeight meets of a person of that height, in the person's frame.
std::vector<Polygon> legCircles(double height);

/// Radius of the circle about a person of that height that no thing may reach into.
double humanRadius(double height);

}  // namespace ispace
