// SPDX-License-Identifier: GPL-3.0-or-later
// Covariances of odometry, as they follow from a robot's noise.
//
// Errors of a turn and of a way are independent, with variances of alpha1 |turn| + alpha2 |way|
// rad2 and alpha3 |way| + alpha4 |turn| m2: the odometry motion model of S. Thrun, W. Burgard, D.
// Fox, Probabilistic Robotics, 2005, with variances in proportion to the way, so that they do not
// depend on the length of a step. Poses are compounded to the first order (R. C. Smith, P.
// Cheeseman, On the representation and estimation of spatial uncertainty, 1986). Pure functions,
// O(1).
//
//     EstimatedPose robot{start};
//     const PoseCovariance step = covarianceOf(motion, alphasOf(model.noise));
//     robot.covariance = propagated(robot.covariance, robot.pose.heading, motion, step);
#pragma once

#include <array>

#include "geom/pose.h"
#include "scene/robot.h"

namespace ispace {

/// Covariance of the errors of a pose: x and y in metres, heading h in radians.
struct PoseCovariance {
    double xx = 0, xy = 0, yy = 0, xh = 0, yh = 0, hh = 0;
    friend bool operator==(const PoseCovariance&, const PoseCovariance&) = default;
};

/// A pose with the covariance of its errors.
struct EstimatedPose {
    Pose2 pose;
    PoseCovariance covariance = {};
};

/// Alpha 1 to 4 of errors of motion, see strayed() in lib/engine/sim/odometry.h.
using MotionAlphas = std::array<double, 4>;

/// Returns the alphas of the errors of odometry against the true motion.
MotionAlphas alphasOf(const MotionNoise& noise);

/// Returns the covariance of the errors of a motion, in the frame of its start: the first order of
/// those that strayed() draws.
PoseCovariance covarianceOf(const Pose2& motion, const MotionAlphas& alphas);

/// Returns the covariance of an estimated pose after a motion, whose errors are independent of
/// those before. First order: exact for headings that are known, and within a tenth of the errors
/// while their deviation is below some 20 degrees.
/// \param before of the pose before \param heading the estimate before
/// \param step covariance of the motion, in the frame of its start
PoseCovariance propagated(const PoseCovariance& before, Angle heading, const Pose2& motion,
                          const PoseCovariance& step);

/// Returns the covariance of a mean velocity over some seconds, in the robot's frame: with x and y
/// in m/s and h in radians a second. Its integral grows as the covariance of poses does.
/// \pre seconds > 0
PoseCovariance twistCovariance(Vec2 velocity, Angle rate, const MotionAlphas& alphas,
                               double seconds);

}  // namespace ispace
