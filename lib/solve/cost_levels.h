// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstddef>
#include <vector>

#include "solve/problem.h"

namespace ispace {

/// What sets of sensors can cost, each on a candidate of its own, ascending from level 0, nothing,
/// up to some cost. Sums that are the same but for rounding (isCheaper) are one level. If there are
/// more than 4000 the levels are even steps instead, rounded down to a few digits, with sums
/// between them.
class CostLevels {
  public:
    /// O(4000 * kinds * log of how many of each)
    CostLevels(const std::vector<Kind>& kinds, double most);

    [[nodiscard]] std::size_t size() const { return levels_.size(); }
    [[nodiscard]] bool isEven() const { return is_even_; }
    /// The budget that buys what level i costs, and nothing of level i + 1.
    [[nodiscard]] double at(std::size_t i) const { return levels_[i].most; }
    /// The highest level that is cheaper; 0 if none is.
    [[nodiscard]] std::size_t below(double cost) const;
    /// What at(i) does not buy costs at least this; infinite if level i is the last.
    [[nodiscard]] double above(std::size_t i) const;

  private:
    /// Sums that are the same but for rounding.
    struct Level {
        double least = 0, most = 0;
    };
    /// With so many more sensors of a cost, or without them.
    void mayAdd(std::size_t count, double cost, double most);
    void setEven(double most);

    std::vector<Level> levels_ = {Level()};
    bool is_even_ = false;
};

}  // namespace ispace
