// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/calibration: poses of fixed sensors, odometry and rooms from logs.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "env/environment.h"
#include "scene/sensor/sensor.h"

namespace ispace::calibration {

/// Covariance of (x, y, heading): metres and radians. An infinite variance: not observed.
using PlanCovariance = std::array<std::array<double, 3>, 3>;

/// A motion that the readings do not determine, as a unit vector: metres along x and y of the room,
/// and radians times 1 m. A pure turn about the point `about` if it turns.
struct FreeMotion {
    double x = 0, y = 0, turn = 0;
    [[nodiscard]] bool turns() const;
    /// Point that stays while the sensor at `pose` turns. \pre turns()
    [[nodiscard]] Point2 centre(const Pose3& pose) const;
    /// "along the direction 30 deg", "about the point (2.00, 1.50)".
    [[nodiscard]] std::string text(const Pose3& pose) const;
};

/// The pose of a fixed laser, estimated from its scans.
struct PlanFit {
    Pose3 pose;                       ///< height, tilt and roll are those of the start
    PlanCovariance covariance = {};   ///< after Gauss and Markov, at the scatter of the residuals
    std::vector<FreeMotion> unknown;  ///< along these the pose is that of the start
    std::vector<Pose3> equals;        ///< other poses as likely as this one, nearest first
    std::size_t scans = 0;
    std::size_t beams = 0;  ///< with returns in most scans
    double inliers = 0;     ///< share of them within kPlanInlier of the plan
    double sigma = 0;       ///< metres: scatter of their means about the plan, robust
};

/// Distance to the plan up to which a beam agrees with it, in metres, and the share of beams that
/// has to: with fewer the scans are of another room.
constexpr double kPlanInlier = 0.2, kPlanAgreement = 0.6;

/// Estimates the pose of a fixed laser in a known room, by least squares over the ranges that this
/// library simulates (Levenberg and Marquardt, robust weights).
///
/// A beam counts with the mean of its ranges over all scans about their densest half, so that
/// people may hide it half of the time. Starts are searched in the whole room for a level laser,
/// and within 1.2 m and 25 degrees of `start` for others. Of several equally likely poses (a factor
/// of e^4.5) the one nearest to `start` is returned, the others are listed.
///
/// Costs some 0.4 s for a laser of 1081 beams in a room of 100 m2.
/// \param scans ranges of each scan, laser.beams numbers each; infinite: no return
/// \throws FormatError without a diagnostic's file: no scans, scans of another number of beams, too
///         few returns, scans that do not fit the room
PlanFit fitToPlan(const Environment& environment, const Sensor& start,
                  std::span<const std::vector<float>> scans);

}  // namespace ispace::calibration
