// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of motion, odometry and starts.
//
// A robot's wheels slip (motion) and are measured wrongly (odometry). Both errors are drawn for
// each step, by the seed, the robot's id and the number of the step, so that a run is repeated
// exactly and other robots do not change it. Their variance grows with the way, whatever the length
// of a step. The covariance of an estimate is propagated to first order
// (scene/odometry_covariance.h).
//
// The model follows S. Thrun, W. Burgard, D. Fox, Probabilistic Robotics, 2005, section 5.4, but
// for variances in proportion to the way, see strayed().
//
//     // 5 mm ahead, with a standard deviation of 0.7 mm:
//     const Pose2 moved = strayed({{0.005, 0}, {}}, {0, 0, 1e-4, 0}, key);
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"
#include "geom/pose.h"
#include "scene/odometry_covariance.h"
#include "sense/scan.h"
#include "sim/collision.h"
#include "sim/mover.h"
#include "sim/wheel_travel.h"

namespace ispace {

/// The way from one pose to another along an arc, turning at a constant rate: the path of a robot
/// at constant speeds. It turns by the shorter way, at most half a turn.
class ArcPath {
  public:
    ArcPath(const Pose2& from, const Pose2& to);

    /// Returns the pose after a share of the way: 0 gives `from`, 1 exactly `to`.
    [[nodiscard]] Pose2 at(double share) const;
    /// Computes poses of a frame fixed to the mover at the shares first + k * step and writes them
    /// to `frames` from number `begin` to before `end`. \param mount its pose in the mover's frame
    void carry(const Pose2& mount, double first, double step, std::size_t begin, std::size_t end,
               BeamFrames& frames) const;

  private:
    Pose2 from_, to_;
    Angle turn_;
    double half_;   // of the turn, in radians
    Vec2 chord_;    // turned back by half_: the initial direction, as long as the chord
    double whole_;  // sin(half_) / half_
};

/// Returns `to` in the frame of `from`.
Pose2 relativePose(const Pose2& from, const Pose2& to);
/// Returns a pose of the inner frame in the outer one.
Pose2 composed(const Pose2& outer, const Pose2& inner);

/// Returns a motion of a step, in the frame of its start, with errors drawn by a key:
///
///     turn   N(0, alpha1 |turn| + alpha2 |way|)   half before the way, half behind it
///     way    N(0, alpha3 |way| + alpha4 |turn|)   along itself
///
/// in radians and metres. These are the alphas of the odometry motion model of Thrun, Burgard and
/// Fox, Probabilistic Robotics, 2005, section 5.4, whose errors of an increment d have the variance
/// alpha d^2. Errors of independent steps must add up to a spread that does not depend on the step
/// length, so here the variance grows in proportion to the way: the same for a turn of one radian
/// and a way of one metre.
Pose2 strayed(const Pose2& motion, const MotionAlphas& alphas, const RandomKey& key);

/// Moves the robots' starts by their start errors, drawn up to a hundred times until the start is
/// free. \returns the robots without a free one, which start as written
std::vector<std::size_t> strayStarts(std::span<Mover> movers, const ObstacleSets& obstacles,
                                     std::uint64_t seed);

/// Returns the way along the heading and the turn of a step, taken as an arc: exact for straight
/// ways, turns on the spot and constant speeds. The speeds tell whole turns.
WheelTravel travelOf(const Motion& from, const Motion& to, double duration);

/// Computes a robot's pose from its wheels, from 0,0 and heading 0 at the start.
class Odometer {
  public:
    Odometer() = default;
    Odometer(const Mover& mover, std::uint64_t seed, bool noise);

    /// Replaces the wheels' motion of the step by the true one, and stores the former.
    /// \returns the offset of the true end from the end by the wheels
    Vec2 stray(Motion& end, const Pose2& start, std::int64_t step);
    /// Records that the step was cancelled: the wheels stood still.
    void stay() { turned_ = {}; }
    /// Adds the motion of a step to travel().
    void roll(const WheelTravel& step) {
        travel_.driven += step.driven;
        travel_.turned = travel_.turned + step.turned;
    }
    [[nodiscard]] const WheelTravel& travel() const { return travel_; }
    /// Updates the odometry by the step, with its errors.
    void count(std::int64_t step);

    /// Returns the estimated pose. \param truth the true pose
    [[nodiscard]] Pose2 pose(const Pose2& truth) const {
        return counts_ ? pose_ : relativePose(origin_, truth);
    }
    /// Returns the covariance of the estimated pose's errors against the true one, in the frame of
    /// odometry: of errors of the motion and of the odometry. 0 without noise.
    [[nodiscard]] const PoseCovariance& covariance() const { return covariance_; }
    /// Returns the alphas of both errors together; 0 without noise.
    [[nodiscard]] MotionAlphas alphas() const { return counts_ ? alphas_ : MotionAlphas{}; }
    /// Sets the estimated pose from a record.
    void put(const EstimatedPose& estimate) {
        pose_ = estimate.pose;
        covariance_ = estimate.covariance;
        counts_ = true;
    }
    /// Goes on from another one after a jump of the mover, which the wheels do not notice.
    /// \param was pose before it \param now pose after it
    void goOn(const Odometer& before, const Pose2& was, const Pose2& now) {
        *this = before;
        const Pose2 way = relativePose(origin_, was);
        origin_ = composed(now, relativePose(way, Pose2{}));
    }
    /// Returns true if the motion or the odometry has errors.
    [[nodiscard]] bool isNoisy() const { return counts_; }

  private:
    MotionNoise noise_;
    std::uint64_t seed_ = 0, id_ = 0;
    bool counts_ = false, drifts_ = false;
    MotionAlphas alphas_{};  // of motion and odometry together
    Pose2 origin_;
    Pose2 pose_;  // estimate so far
    PoseCovariance covariance_;
    Pose2 turned_;  // motion of the wheels in this step
    WheelTravel travel_;
};

}  // namespace ispace
