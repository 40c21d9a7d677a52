// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/cover only.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/angle.h"
#include "geom/point.h"

namespace ispace {

/// Half the angle, in radians, about a limit in which cells are settled one by one: far more than
/// the 1e-9 degrees that count as on the limit and all that rounds.
constexpr double kNearLimit = 1e-9;

/// A direction between sectors.
struct SectorLimit {
    double degrees = 0;
    Vec2 unit;
    /// Cotangents a little clockwise of it and a little counter-clockwise.
    double before = 0, beyond = 0;
};

/// The limits that lie above the level line through the place, or below it, and the part before the
/// first of them (of all without any); those on the line have no row of cells to cut.
struct LimitsOfHalf {
    std::size_t first = 0, count = 0;  ///< limits first, first + 1, ..., counter-clockwise
    std::size_t first_part = 0;
};

/// Where the sectors' limits cross the rows.
class SectorLimits {
  public:
    void set(std::span<const Angle> angles);
    [[nodiscard]] std::size_t size() const { return limits_.size(); }
    [[nodiscard]] const SectorLimit& operator[](std::size_t i) const { return limits_[i]; }
    [[nodiscard]] const LimitsOfHalf& upper() const { return upper_; }
    [[nodiscard]] const LimitsOfHalf& lower() const { return lower_; }

    /// The one rule: the part in which a cell lies. \pre offset != Vec2{}
    [[nodiscard]] std::size_t partOf(Vec2 offset) const;
    /// The same for one that is near to limit i, mostly without arc tangent.
    [[nodiscard]] std::size_t partNear(std::size_t i, Vec2 offset) const;

  private:
    void setHalf(LimitsOfHalf& half, double side);

    std::vector<Angle> angles_;
    std::vector<SectorLimit> limits_;
    LimitsOfHalf upper_, lower_;
};

}  // namespace ispace
