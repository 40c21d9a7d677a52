// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim: how motion, odometry and starts stray.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"
#include "geom/pose.h"
#include "sense/scan.h"
#include "sim/collision.h"
#include "sim/mover.h"

namespace ispace {

/// The way from one pose to another along an arc, turning evenly: how a robot goes at constant
/// speeds. It turns by the shorter way, at most half a turn.
class ArcWay {
  public:
    ArcWay(const Pose2& from, const Pose2& to);

    /// Where a share of the way ends: 0 gives `from`, 1 exactly `to`.
    [[nodiscard]] Pose2 at(double share) const;
    /// Where something fixed to the mover is at the shares first + k * step: sets `frames` from
    /// number `begin` to before `end`. \param mount its pose in the mover's frame
    void carry(const Pose2& mount, double first, double step, std::size_t begin, std::size_t end,
               BeamFrames& frames) const;

  private:
    Pose2 from_, to_;
    Angle turn_;
    double half_;   // of the turn, in radians
    Vec2 chord_;    // turned back by half_: so the way begins, if it were as long
    double whole_;  // sin(half_) / half_
};

/// `to` in the frame of `from`.
Pose2 relativePose(const Pose2& from, const Pose2& to);
/// A pose of the inner frame in the outer one.
Pose2 composed(const Pose2& outer, const Pose2& inner);

/// A motion of a step, in the frame where it begins, with errors drawn by a key:
///
///     turn   N(0, alpha1 |turn| + alpha2 |way|)   half before the way, half behind it
///     way    N(0, alpha3 |way| + alpha4 |turn|)   along itself
///
/// in radians and metres. These are the alphas of the odometry motion model of Thrun, Burgard and
/// Fox, Probabilistic Robotics, 2005, section 5.4, whose errors of an increment d have the variance
/// alpha d^2. Errors of independent steps add up to a spread that must not depend on how long they
/// are, so here it grows in proportion to the way: the same for a turn of one radian and a way of
/// one metre.
Pose2 strayed(const Pose2& motion, const std::array<double, 4>& alphas, const RandomKey& key);

/// True if one of them is not 0.
bool strays(const std::array<double, 4>& alphas);

/// Moves the robots' starts by their start errors, where there is room: drawn up to a hundred
/// times, a robot else starts as written. \returns those who do
std::vector<std::size_t> strayStarts(std::span<Mover> movers, const ObstacleSets& obstacles,
                                     std::uint64_t seed);

/// What a robot makes of its wheels: pose and nothing else, from 0,0 and heading 0 at the start.
class Odometer {
  public:
    Odometer() = default;
    Odometer(const Mover& mover, std::uint64_t seed, bool noise);

    /// The step's true motion instead of that of the wheels, and remembers the latter.
    /// \returns how far the end lies from where the wheels would have led
    Vec2 stray(Motion& end, const Pose2& start, std::int64_t step);
    /// The step was cancelled: the wheels stood still.
    void stay() { turned_ = {}; }
    /// Counts the step, and its errors.
    void count(std::int64_t step);

    /// As it believes to be. \param truth its true pose
    [[nodiscard]] Pose2 pose(const Pose2& truth) const {
        return counts_ ? pose_ : relativePose(origin_, truth);
    }
    /// It believes to be there, as a record says.
    void put(const Pose2& pose) {
        pose_ = pose;
        counts_ = true;
    }
    /// Moves stray, or are counted wrong.
    [[nodiscard]] bool isNoisy() const { return counts_; }

  private:
    MotionNoise noise_;
    std::uint64_t seed_ = 0, id_ = 0;
    bool counts_ = false, drifts_ = false;
    Pose2 origin_;
    Pose2 pose_;    // counted so far
    Pose2 turned_;  // by the wheels in this step
};

}  // namespace ispace
