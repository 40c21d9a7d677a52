// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "solve/problem.h"

namespace ispace {

/// The cells of a problem for a Lagrangian relaxation: those that standing sensors cover are
/// settled, and weights are in finer units, as multipliers are fractions of them.
///
/// Multiplicities and needs are divided by the greatest common divisor of the multiplicities, needs
/// rounded up: with multiplicities of 4 a need of 5 takes two sensors, as 8 does.
struct RelaxedCells {
    std::uint32_t scale = 1;    ///< fine units in one unit of the problem's weights
    std::uint64_t settled = 0;  ///< weight of cells that are covered already, fine
    /// Fine; 0 for cells that are settled, do not count, or cannot be covered.
    std::vector<std::uint32_t> weights;
    std::vector<std::uint16_t>
        needs;  ///< multiplicity still required; at least 1 where there is weight
    std::vector<std::uint16_t> multiplicities;  ///< of a sensor, per kind

    explicit RelaxedCells(const Problem& problem);
    /// In whole units of the problem. \param value an upper bound, fine
    [[nodiscard]] std::uint64_t whole(std::uint64_t value) const { return value / scale; }
    /// The most fine units that are not more than `value`, in units of the problem.
    [[nodiscard]] std::uint64_t most(std::uint64_t value) const {
        return value * scale + (scale - 1);
    }
};

/// Reduced cost of a cell with this multiplier for a sensor that meets `multiplicity` of its need:
/// at most the multiplier, rounded up so that bounds hold.
inline std::uint32_t reducedCost(std::uint32_t multiplier, std::uint32_t multiplicity,
                                 std::uint32_t need) {
    if (multiplicity >= need) return multiplier;
    return static_cast<std::uint32_t>((std::uint64_t{multiplier} * multiplicity + need - 1) / need);
}

/// The fraction of a need that a sensor meets.
inline float partOf(std::uint32_t multiplicity, std::uint32_t need) {
    return multiplicity >= need ? 1.0F
                                : static_cast<float>(multiplicity) / static_cast<float>(need);
}

/// How many sensors of each kind may be placed, each on a candidate of its own: all ways within
/// `most` and the budget that leave no room for one more of the last kind.
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

    /// The best counts for given reduced costs.
    struct Best {
        std::uint64_t value = 0;          ///< no allowed counts give more
        std::vector<std::size_t> counts;  ///< of each kind, for about that value
        std::vector<std::uint64_t> with;  ///< with[k] + the reduced cost of a candidate of kind k
                                          ///< bounds solutions with that candidate
        std::vector<char> may;            ///< may[k]: one of kind k fits at all
    };
    /// \param sums sums[k][n]: the n best reduced costs of kind k together, n up to most(k)
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

/// How a MultiplierSearch goes about it.
struct SearchPace {
    /// Of the first step: 1 leads to the target if the bound were a plane.
    double factor = 1;
    /// The least part that a new subgradient has in the average, relative to the most it may have.
    double least_part = 0.1;
    /// After so many trials with next to no gain new subgradients have less part: the average
    /// settles. 0: never.
    int patience = 0;
};
/// For some hundreds of trials: comes nearer to the lowest bound.
constexpr SearchPace kLongPace = {.factor = 1, .least_part = 0.4, .patience = 10};
/// For some tens of trials from a start that is nearly as good as can be: a longer step only leads
/// away.
constexpr SearchPace kWarmPace = {.factor = 0.5, .least_part = 0.1, .patience = 0};

/// Searches for the Lagrange multipliers with the lowest bound, trial by trial: the volume
/// algorithm (Barahona & Anbil 2000), a subgradient method that steps from the best multipliers so
/// far along an average of the subgradients, so that it neither swings between sensors that are
/// nearly alike nor needs many steps.
class MultiplierSearch {
  public:
    /// \param weights of the cells: the multipliers are from 0 to these
    /// \param start the first trial
    /// \param target a value that the bound will not pass, or about
    MultiplierSearch(std::span<const std::uint32_t> weights, std::vector<std::uint32_t> start,
                     double target, const SearchPace& pace = SearchPace());

    [[nodiscard]] const std::vector<std::uint32_t>& trial() const { return trial_; }
    [[nodiscard]] const std::vector<std::uint32_t>& best() const { return best_; }
    /// The lowest bound reported; infinite before the first report.
    [[nodiscard]] double bound() const { return bound_; }
    /// What the trial gave, and the next trial.
    /// \param cover fraction of each cell's need that the best sensors meet
    void report(double bound, std::span<const float> cover);
    /// The best multipliers have another bound, and are to be gone on from: there are more sensors
    /// to choose from than the last trials knew.
    void restart(double bound, std::span<const float> cover);
    /// The part that the last trial has in the average.
    [[nodiscard]] double part() const { return part_; }

  private:
    void settle();
    void step();

    std::span<const std::uint32_t> weights_;
    double target_;
    SearchPace pace_;
    double bound_ = std::numeric_limits<double>::infinity(), settled_ = bound_;
    double factor_, mixing_ = 0.2, part_ = 1;
    int failures_ = 0, reports_ = 0;
    std::vector<std::uint32_t> trial_, best_;
    std::vector<float> average_;  // of cover
};

}  // namespace ispace
