// SPDX-License-Identifier: GPL-3.0-or-later
// Robots and people as records describe them, and the poses of what they carry.
//
// A robot's frame lies on the floor, with the origin at the centre of rotation and x forward;
// bearings and turns are counter-clockwise. Metres, seconds. Written keys win over those of the
// model, and these over the bare robot's.
//
//     const RobotModel robot = robotOf(record, devices);
//     const Wheels wheels = wheelsOf(robot);  // of the data sheet, or estimated from the body
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/devices.h"

namespace ispace {

struct PersonFigure;

/// Returns the share of kMaxSwingDegrees by which a person's limbs swing at a speed in m/s: 1 from
/// 0.5 m/s on.
double shareOfSwing(double speed);

/// Computes the angle of a walking person's left leg ahead of the hip, as humanParts() takes it.
/// \param phase share of the stride in [0, 1); the left leg is ahead in its first half
/// \param speed m/s
Angle limbSwing(double phase, double speed);

/// Converts a world pose to the frame of a carrier on the floor: the inverse of mountedPose().
Pose3 poseOn(const Pose2& carrier, const Pose3& pose);

/// The motions that a robot's wheels permit.
enum class Drive {
    Differential,  ///< drive along the heading and turn
    Omni           ///< sideways, too, at the same time
};

/// Errors of a robot's motion and odometry, see lib/engine/sim/odometry.h. All zero: exact.
struct MotionNoise {
    /// Thrun's alpha 1 to 4: of the true motion against the wheels' turns, and of the odometry.
    std::array<double, 4> motion{}, odometry{};
    double start_place = 0;  ///< standard deviation of x and of y at the start, metres
    Angle start_heading;     ///< standard deviation of the heading at the start
    friend bool operator==(const MotionNoise&, const MotionNoise&) = default;
};

/// A sector of a robot's rim that reports contact, counter-clockwise.
struct Bumper {
    Angle from, to;  ///< bearings in the robot's frame
    friend bool operator==(const Bumper&, const Bumper&) = default;
};

/// The two driven wheels of a differential drive, at the sides of the centre of rotation.
struct Wheels {
    double radius = 0;  ///< metres
    double track = 0;   ///< from the middle of one to that of the other, metres
    friend bool operator==(const Wheels&, const Wheels&) = default;
};

/// The ring of sonars of a robot, all of one kind.
struct SonarRing {
    std::vector<Pose2> places;              ///< in the robot's frame
    double min_range = 0.1, max_range = 5;  ///< nearer echoes return the minimum
    Angle fov = Angle::degrees(15);         ///< full angle of the cone
    friend bool operator==(const SonarRing&, const SonarRing&) = default;
};

/// A robot on wheels. Its frame has the origin on the floor at the centre of rotation and x
/// forward. The bare robot, without model, turns in a circle of 0.3 m as the thesis' does and
/// moves like a Pioneer.
struct RobotModel {
    std::string model;    ///< "" for the bare robot
    double radius = 0.3;  ///< of the collision circle about the centre of rotation
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
    Drive drive = Drive::Differential;
    double max_sidespeed = 0;  ///< m/s, to either side; 0 but for Drive::Omni
    Wheels wheels;             ///< all 0: unknown, see wheelsOf()
    MotionNoise noise;
    SonarRing sonar;
    std::vector<Bumper> bumpers;
    friend bool operator==(const RobotModel&, const RobotModel&) = default;
};

/// Returns the wheels of a differential drive; without them a track of 0.8
/// of the body's width, and a radius of half of its height, but at most a fifth of its width.
Wheels wheelsOf(const RobotModel& model);

/// The autonomous motion of a robot or a person.
struct MotionPlan {
    std::vector<Point2> path;  ///< waypoints, in order
    bool loop = false;         ///< from the last waypoint to the first, repeatedly
    double pause = 0;          ///< seconds to stay at each waypoint
    bool wander = false;       ///< moves at random where the way is free; with a path, after its
                               ///< end
    friend bool operator==(const MotionPlan&, const MotionPlan&) = default;
};

/// A robot in its starting pose.
struct PlacedRobot {
    std::string id;
    RobotModel model;
    Pose2 pose;            ///< of the centre of rotation
    SourcePosition place;  ///< of its record, for messages
    MotionPlan course = {};
};

/// A person in the starting pose.
struct PlacedPerson {
    std::string id;
    double height = 1.7;
    double speed = 1.2;  ///< m/s, when walking
    Pose2 pose;
    SourcePosition place;  ///< of the record, for messages
    MotionPlan course = {};
    /// Null for a body as that of humanParts(); see personParts().
    std::shared_ptr<const PersonFigure> figure = {};
};

/// Reads the parameters of a `robot` record: its explicit keys, else its model's, else the bare
/// robot's.
/// \throws FormatError with all findings: an unknown model, a model of another kind, a speed above
/// its maximum
RobotModel robotOf(const Record& record, const DeviceCatalogue& devices);

/// Returns `base` with the parameters that a record writes; the model stays. A written max_speed
/// below the speed of `base` lowers that; the same holds for the turn. A robot that becomes
/// omnidirectional moves sideways as fast as forward unless the record gives another speed.
/// \throws FormatError as robotOf
RobotModel withParameters(RobotModel base, const Record& record);

/// Reads the keys of a `robot` or `human` record that describe its autonomous motion.
MotionPlan courseOf(const Record& record);

/// Reads the pose of a `robot` record, or of any other with `at` and `heading`; without `at` at
/// 0,0.
Pose2 floorPoseOf(const Record& record);

}  // namespace ispace
