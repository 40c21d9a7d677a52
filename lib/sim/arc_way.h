// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim.
#pragma once

#include "geom/pose.h"
#include "sense/scan.h"

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

}  // namespace ispace
