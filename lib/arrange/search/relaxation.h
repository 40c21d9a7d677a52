// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "arrange/search/problem.h"
#include "arrange/search/search.h"

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

/// Lagrangian relaxation over all candidates: reduced costs, the best candidates by them, and those
/// that are ruled out.
class RootRelaxation {
  public:
    explicit RootRelaxation(const Problem& problem);

    [[nodiscard]] const RelaxedCells& cells() const { return cells_; }
    [[nodiscard]] const CountChoice& counts() const { return counts_; }

    /// Initial multipliers from a good solution: the weight of a cell that at most one sensor sees,
    /// 0 where more do.
    [[nodiscard]] std::vector<std::uint32_t> startFrom(const std::vector<Choice>& chosen) const;

    /// The bound for these multipliers over all remaining candidates, or over the working set, in
    /// fine units. The members below refer to the last call.
    std::uint64_t evaluate(const std::vector<std::uint32_t>& multipliers, bool is_all);
    /// Fraction of each cell's need that the best candidates meet.
    [[nodiscard]] const std::vector<float>& cover() const { return cover_; }

    /// After evaluate() of all: reduced-cost fixing, rules out candidates that are in no solution
    /// better than `cut` (fine). \return an upper bound, at most cut, of solutions with any of them
    std::uint64_t ruleOut(std::uint64_t cut);
    /// After evaluate() of all: adds the sites of the `count` best reduced costs of each kind to
    /// the working set.
    void widen(std::size_t count);
    /// Rules out all others. \param kept per kind, ascending
    void keepOnly(const std::vector<std::vector<std::uint32_t>>& kept);

    /// Per kind, those not ruled out.
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> survivors() const;

  private:
    struct OfKind {
        const CandidateSet* candidates = nullptr;
        std::vector<char> is_out;
        std::vector<std::uint32_t> sites, working;  ///< with candidates left; to be weighed
        std::vector<char> is_working;
        std::vector<std::uint32_t> reduced_costs;
        std::vector<std::uint32_t> top;  ///< the best, their number at most counts_.most()
    };

    void setReducedCosts(const std::vector<std::uint32_t>& multipliers);
    void weighSites(std::size_t kind, const std::vector<std::uint32_t>& sites);
    void findTop(std::size_t kind, const std::vector<std::uint32_t>& sites, std::size_t count);
    void setCover();

    const Problem& problem_;
    RelaxedCells cells_;
    CountChoice counts_;
    std::vector<OfKind> kinds_;
    std::vector<WeightSums> reduced_costs_;  // per kind; of the first with the same multiplicity
    std::vector<std::size_t> sums_of_;       // kind -> index in reduced_costs_
    std::vector<std::uint32_t> shared_;      // scratch: reduced costs for one multiplicity
    std::vector<std::vector<std::uint64_t>> sums_;
    std::uint64_t free_ = 0;  // what the bound is without sensors
    CountChoice::Best best_;
    std::vector<Choice> chosen_;
    std::vector<float> cover_;
};

/// An upper bound, and the multipliers that prove it.
struct Bound {
    std::uint64_t value = 0;  ///< no feasible solution has a larger value
    /// Lagrange multipliers of the cells, in units of 1 / scale of those of weights; each at most
    /// its cell's weight.
    std::vector<std::uint32_t> multipliers;
    std::uint32_t scale = 1;
    /// Per kind, ascending, the candidates that may be part of a solution better than `cut`.
    std::vector<std::vector<std::uint32_t>> survivors;
    std::uint64_t cut = 0;
};

struct LagrangeLimits {
    /// Values up to this are of no interest: the bound need not be lower. No solution with this
    /// value need exist.
    std::uint64_t cut = 0;
    double gap = 0;   ///< ends once (bound - cut) / bound is at most this
    int rounds = 24;  ///< maximum number of passes over all candidates
    /// Ends once four rounds gain less than this part of the distance between bound and cut.
    double stall = 0.05;
    SearchPace pace = SearchPace();
};

/// Upper bound of max sum w_i y_i subject to required y_i <= achieved_i + sum_j m_j a_ij x_j and
/// 0 <= y <= 1, by Lagrangian relaxation of the cells' rows and a subgradient method that ends at
/// the gap or when progress stalls. Integer arithmetic: the bound is exact. The same for any number
/// of threads. \param near a solution from which initial multipliers are derived
Bound lagrangianBound(const Problem& problem, const std::vector<Choice>& near,
                      const LagrangeLimits& limits, Progress& progress);

}  // namespace ispace
