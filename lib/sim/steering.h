// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim: which way is free, for those who go by themselves.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/collision.h"
#include "sim/motion.h"
#include "sim/mover.h"
#include "sim/sim_time.h"

namespace ispace {

/// Everybody at one moment, and what stands about.
struct Surroundings {
    std::span<const Mover> movers;
    std::span<const Motion> motions;
    const Traffic* traffic = nullptr;  ///< rebuilt for that moment
};

/// Where somebody is who looks about.
struct SteeringState {
    const Surroundings* around = nullptr;
    const Obstacles* obstacles = nullptr;
    Vicinity* vicinity = nullptr;  ///< of the mover, among these obstacles
    std::size_t mover = 0;
    double clearance = 0;  ///< nothing is nearer to the mover's circle
    SimTime time{}, step{};
};

/// A direction, and for how many seconds one can go there.
struct FreeHeading {
    Angle direction;
    double time = 0;
};

/// Looks for a free way about one mover at one moment: things stand, the others keep their
/// velocities (velocity obstacles; Fiorini and Shiller, Motion Planning in Dynamic Environments
/// Using Velocity Obstacles, 1998). What it stands too near to is in the way only if it gets
/// nearer.
class Steering {
  public:
    /// Looks ahead as far as one gets in `horizon` seconds at `speed`.
    Steering(const SteeringState& helm, double speed, double horizon);

    /// Seconds until somebody or something is in the way, at most `horizon`; until things in steps
    /// of a half, a quarter, an eighth of it.
    [[nodiscard]] double freeTime(Angle direction) const { return freeTime(direction, 1); }
    /// The desired direction if it is free for `needed` seconds; else the nearest one that is, up
    /// to a little more than square; else the one that is free longest, less so the farther it
    /// leads aside. Who turns aside to pass somebody turns back in time: things count for a quarter
    /// of the horizon there. Of left and right it is right, so that two who meet pass each other.
    [[nodiscard]] FreeHeading choose(Angle desired, double needed) const;

  private:
    struct Neighbour {
        Vec2 offset, velocity;
        double reach;  // of both circles and the gap
    };
    void findNeighbours(const Surroundings& around, std::size_t mover);
    void findLines(const SteeringState& helm);
    [[nodiscard]] double untilNeighbour(Vec2 velocity) const;
    [[nodiscard]] double untilLine(Vec2 velocity, double most) const;
    [[nodiscard]] double freeTime(Angle direction, double share) const;

    struct Line {
        Segment2 line;
        double reach;
    };
    Point2 place_;
    double radius_, speed_, horizon_;
    std::vector<Neighbour> neighbours_;
    std::vector<Line> lines_;
};

}  // namespace ispace
