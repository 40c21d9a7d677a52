// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/sim: surroundings of robots' sonars, which spare most rays.
//
// Each surface bounds the distance along each ray from below; rays whose bound is beyond an echo
// that is known are not cast. Bounds have a margin of kEchoSlack, so ranges are those of all 37
// rays.
#pragma once

#include <cstdint>
#include <vector>

#include "env/environment.h"
#include "env/slice.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "scene/robot.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

/// Margin around sonars' cones, for rounding and the approximation of round bodies, in metres.
constexpr double kEchoSlack = 1e-3;

/// Returns the height of the highest point that a robot's sonars reach.
double sonarTop(const RobotModel& model);
/// Returns the distance from the robot's centre up to which its sonars measure.
double sonarReach(const RobotModel& model);
/// Returns all surfaces up to a height that send sound back, as seen from above.
Slice echoBand(const Environment& environment, double top);

/// Surfaces of an echoBand() and moving bodies within sonarReach() of a robot.
struct SonarVicinity {
    /// A rectangle that holds a body, as seen from above.
    struct Body {
        Point2 middle;
        Vec2 ahead;  ///< unit vector along its length
        double half_length, half_width;
        double radius;  ///< of a circle that holds the body, too
    };

    bool is_within_solid = false;  ///< a sonar may be: surfaces are in all directions
    std::vector<Segment2> lines;
    std::vector<Body> bodies;
};

/// Computes the same as sonarRanges(), with only those rays that may meet the nearest of them.
/// Without a vicinity it casts all.
std::vector<float> sonarRangesNear(const SonarVicinity* vicinity, const RobotModel& model,
                                   const Pose2& pose, const RayWorld& environment,
                                   const MovingBodies& bodies, std::uint32_t own);

}  // namespace ispace
