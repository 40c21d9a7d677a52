// SPDX-License-Identifier: GPL-3.0-or-later
// Wheels, axle and laser of a differential drive, from one drive.
//
// The speeds of the wheels and the motion of the laser between two scans are enough: no marks, no
// measured distance. The way has to turn and to run straight; a drive that does not determine a
// parameter is refused.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"

namespace ispace::calibration {

/// A piece of a drive: the speeds of the wheels, and the motion of the laser by scan matching.
struct DriveStep {
    double duration = 0;         ///< seconds
    double left = 0, right = 0;  ///< speeds of the wheels, rad/s
    Pose2 motion;                ///< of the laser, in its frame before the step
};

/// Parameters of a differential drive with a laser.
struct DriveParameters {
    double left_radius = 0, right_radius = 0;  ///< of the wheels, m
    double axle = 0;                           ///< distance between the wheels, m
    Pose2 laser;                               ///< in the frame of the robot, x forward
};

/// Parameters fitted to a drive.
struct DriveFit {
    DriveParameters parameters;
    /// In the order left radius, right radius, axle, laser x, y, heading; metres and radians.
    std::array<std::array<double, 6>, 6> covariance = {};
    std::size_t steps = 0;    ///< of the drive
    std::size_t inliers = 0;  ///< steps that count
    /// Standard deviations of scan matching, from the residuals: x, y in metres, heading in
    /// radians.
    std::array<double, 3> noise = {};
};

/// Returns true for lines of JSON with the keys of readDrive().
bool isDrive(std::string_view bytes);

/// Reads a drive: JSON objects, a line each or one after another, with `T` (seconds), `phi_l` and
/// `phi_r` (speeds of the wheels, rad/s), `sm` ([x, y, heading], metres and radians). \throws
/// FormatError with the line
std::vector<DriveStep> readDrive(std::string_view bytes, const std::string& name);

/// Computes the motion of the laser in a step.
Pose2 predictedMotion(const DriveParameters& parameters, const DriveStep& step);

/// Fits wheels, axle and pose of the laser at once, in closed form (Censi, Franchi, Marchionni and
/// Oriolo, Simultaneous calibration of odometry and sensor parameters for mobile robots, 2013),
/// after which the worst 1 % of the steps is left out, four times. Covariances are those of Cramer
/// and Rao at the scatter of the residuals. \throws FormatError if the drive does not determine the
/// parameters: the message names those
DriveFit fitDrive(std::span<const DriveStep> steps, const std::string& name);

/// Text for people, with standard deviations, and JSON of schema ispace-drive/1; both end in a
/// newline.
std::string driveText(const DriveFit& fit);
std::string driveJson(const DriveFit& fit);

}  // namespace ispace::calibration
