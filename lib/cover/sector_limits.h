// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/cover only.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/point.h"

namespace ispace {

/// Half the angle, in radians, about limits in which cells are settled one by one: far more than
/// the width of a group of limits and all that rounds.
constexpr double kNearLimit = 1e-9;

/// Limits so near to each other that rows are cut at all of them at once: first, first + 1, ...,
/// end - 1. The cells near to them are settled one by one.
struct LimitGroup {
    std::size_t first = 0, end = 0;
    Vec2 unit;  ///< the direction of the first
    /// Cotangents a little clockwise of them and a little counter-clockwise.
    double before = 0, beyond = 0;
};

/// The groups that lie above the level line through the place, or below it, and the part before the
/// first of them (of all without any); those on the line have no row of cells to cut.
struct LimitsOfHalf {
    std::size_t first = 0, count = 0;  ///< groups first, first + 1, ..., counter-clockwise
    std::size_t first_part = 0;
};

/// Where the sectors' limits cross the rows. Part i holds directions from limit i on to before the
/// next one.
class SectorLimits {
  public:
    /// \pre ascending within (-180, 180] degrees, all different
    void set(std::span<const Angle> limits);
    [[nodiscard]] std::size_t parts() const { return limits_.size(); }
    [[nodiscard]] std::span<const LimitGroup> groups() const { return groups_; }
    [[nodiscard]] const LimitsOfHalf& upper() const { return upper_; }
    [[nodiscard]] const LimitsOfHalf& lower() const { return lower_; }

    /// The one rule: the part in which a cell lies, by directionOf(). \pre offset != Vec2{}
    [[nodiscard]] std::size_t partOf(Vec2 offset) const;
    /// The same for one that is near to group i, mostly without arc tangent.
    [[nodiscard]] std::size_t partNear(std::size_t i, Vec2 offset) const;

  private:
    void setHalf(LimitsOfHalf& half, double side);
    [[nodiscard]] std::size_t partBefore(std::size_t limit) const {
        return (limit == 0 ? parts() : limit) - 1;
    }

    std::vector<Angle> limits_;
    std::vector<LimitGroup> groups_;
    LimitsOfHalf upper_, lower_;
};

}  // namespace ispace
