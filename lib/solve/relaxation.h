// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "solve/problem.h"

namespace ispace {

/// The cells of a problem as a Lagrangian relaxation wants them: what standing sensors meet is
/// settled, and weights are in finer units, as multipliers are fractions of them.
///
/// Shares and needs are divided by what all shares have in common and needs are rounded up: with
/// shares of 4 a need of 5 takes two sensors, as 8 does.
struct RelaxedCells {
    std::uint32_t scale = 1;    ///< fine units in one unit of the problem's weights
    std::uint64_t settled = 0;  ///< worth of cells that are met already, fine
    /// Fine; 0 where settled or worth nothing, or where all sensors together are too few.
    std::vector<std::uint32_t> weights;
    std::vector<std::uint16_t> needs;  ///< shares that a cell lacks; at least 1 where it has weight
    std::vector<std::uint16_t> shares;  ///< of a sensor, per kind

    explicit RelaxedCells(const Problem& problem);
    /// In whole units of the problem. \param value an upper bound, fine
    [[nodiscard]] std::uint64_t whole(std::uint64_t value) const { return value / scale; }
    /// The most fine units that are not more than `value`, in units of the problem.
    [[nodiscard]] std::uint64_t most(std::uint64_t value) const {
        return value * scale + (scale - 1);
    }
};

/// What a sensor of that share gains for meeting part of a need of cells with this multiplier;
/// rounded up, so that bounds hold. More than is needed counts as all: whole cells are met or not.
inline std::uint32_t priceOf(std::uint32_t multiplier, std::uint32_t share, std::uint32_t need) {
    if (share >= need) return multiplier;
    return static_cast<std::uint32_t>((std::uint64_t{multiplier} * share + need - 1) / need);
}

/// The part of a need that a sensor meets.
inline float partOf(std::uint32_t share, std::uint32_t need) {
    return share >= need ? 1.0F : static_cast<float>(share) / static_cast<float>(need);
}

/// How many sensors of each kind there may be, each on a candidate of its own: all ways that stay
/// within `most` and the budget and leave no room for one more of the last kind.
class CountChoice {
  public:
    explicit CountChoice(const Problem& problem);

    /// The most that may be placed of a kind, whatever is of the others.
    [[nodiscard]] std::size_t most(std::size_t kind) const { return most_[kind]; }
    /// The most sensors together.
    [[nodiscard]] std::size_t total() const { return total_; }
    /// False if there are too many ways to list: then bounds let one sensor be a fraction.
    [[nodiscard]] bool isListed() const { return is_listed_; }
    /// The ways, each a count per kind.
    [[nodiscard]] const std::vector<std::vector<std::size_t>>& ways() const { return ways_; }

    /// What sensors are worth if each has a price.
    struct Best {
        std::uint64_t value = 0;  ///< nothing allowed is worth more
        std::vector<std::size_t>
            counts;  ///< of the best of each kind that are worth that, or nearly
        std::vector<std::uint64_t> with;  ///< with[k] + the price of one of kind k: at most worth
                                          ///< that if this one is chosen; less if none may be
        std::vector<char> may;            ///< may[k]: one of kind k fits at all
    };
    /// \param sums sums[k][n]: the n best prices of kind k together, n up to most(k)
    [[nodiscard]] Best best(std::span<const std::vector<std::uint64_t>> sums) const;

  private:
    void list(std::vector<std::size_t>& counts, std::size_t kind, double spent);
    [[nodiscard]] std::size_t fitting(std::size_t kind, double spent) const;
    [[nodiscard]] std::uint64_t knapsack(std::span<const std::vector<std::uint64_t>> sums,
                                         std::vector<std::size_t>& counts) const;

    std::vector<std::size_t> most_;
    std::vector<double> costs_;
    double budget_ = std::numeric_limits<double>::infinity();
    std::size_t total_ = 0;
    bool is_listed_ = true;
    std::vector<std::vector<std::size_t>> ways_;
};

}  // namespace ispace
