// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "layout/robot.h"
#include "sim/collision.h"
#include "sim/people.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// Indices of the robots in the order in which their moves are settled: by the bytes of their ids.
std::vector<std::size_t> settlingOrder(std::span<const PlacedRobot> robots);

/// Finds the robots and people that a move runs into. Robots come first, people behind them.
///
/// A move is tried against the moves of those that are settled before it and against the others
/// where they stand: whatever these do later, no two ever overlap.
class Traffic {
  public:
    /// `order` as of settlingOrder; a step takes `duration` seconds.
    Traffic(std::span<const PlacedRobot> robots, std::span<const Person> people,
            std::span<const std::size_t> order, double duration);

    /// Takes the places at which the moves begin.
    void rebuild(std::span<const Move> moves);
    /// The first one, in the order of settling, that this robot's move runs into.
    /// \pre moves of those before it are settled: cancelled or not
    [[nodiscard]] std::optional<std::size_t> hit(std::span<const Move> moves,
                                                 std::size_t robot) const;

  private:
    std::vector<std::size_t> rank_;  // in the order of settling
    double reach_ = 0;               // of who gets farthest from its place in a step
    std::vector<Point2> places_;
    FloorGrid grid_;
};

}  // namespace ispace
