// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "geom/pose.h"
#include "layout/devices.h"
#include "record/record.h"

namespace ispace {

/// A robot with two driven wheels. Its frame has the origin on the floor at the centre of rotation
/// and x forward. The bare robot, without model, turns in a circle of 0.3 m as the thesis' does and
/// moves like a Pioneer.
struct RobotModel {
    std::string model;    ///< "" for the bare robot
    double radius = 0.3;  ///< of the circle about the centre of rotation that hits things
    /// The body that sensors see: a box of this length and width, without length a cylinder of
    /// `radius`; its middle lies `center` ahead of the centre of rotation.
    double length = 0, width = 0, center = 0;
    double height = 0.22;                      ///< of the body, from the floor
    double speed = 0.5;                        ///< m/s of FORWARD and BACKWARD
    Angle rotspeed = Angle::degrees(100);      ///< a second, of LEFT and RIGHT
    double max_speed = 1.6;                    ///< m/s, forward and backward
    Angle max_rotspeed = Angle::degrees(300);  ///< a second, either way
    double accel = 0.3;                        ///< m/s^2, speeding up and braking
    Angle rotaccel = Angle::degrees(100);      ///< a second a second
    friend bool operator==(const RobotModel&, const RobotModel&) = default;
};

/// A robot where it starts.
struct PlacedRobot {
    std::string id;
    RobotModel model;
    Pose2 pose;   ///< of the centre of rotation
    Place place;  ///< of its record, for messages
};

/// Parameters of a `robot` record: its explicit keys, else its model's, else the bare robot's.
/// \throws FormatError with all findings: an unknown model, a model of another kind, a speed above
///         its maximum
RobotModel robotOf(const Record& record, const DeviceCatalogue& devices);

/// `base` with the parameters written in a record in place of its own; the model stays. A written
/// max_speed below the speed of `base` lowers that; the same holds for the turn.
/// \throws FormatError as robotOf
RobotModel withParameters(RobotModel base, const Record& record);

/// Pose of a `robot` record, or of any other with `at` and `heading`; without `at` at 0,0.
Pose2 floorPoseOf(const Record& record);

}  // namespace ispace
