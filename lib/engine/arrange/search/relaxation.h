// SPDX-License-Identifier: GPL-3.0-or-later
// Lagrangian upper bounds. The rows that tie cells to sensors are priced (M. L. Fisher, The
// Lagrangian relaxation method for solving integer programming problems, 1981): with prices fixed,
// the best sensors are those of the largest reduced costs. Any prices give a valid bound; the best
// ones give that of the linear program. Prices are whole fractions of weights and round up, so
// bounds are exact whole numbers. One evaluation takes O(runs) at worst, far less by working sets.
//
//     const Bound bound = lagrangianBound(problem, best.chosen, {.cut = best.value}, progress);
//     // no feasible solution has more than bound.value
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "arrange/search/problem.h"
#include "arrange/search/search.h"

namespace ispace {

/// The cells of a problem for a Lagrangian relaxation: cells that standing sensors cover are
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
    /// Converts to whole units of the problem, rounding down.
    /// \param value an upper bound, fine
    [[nodiscard]] std::uint64_t whole(std::uint64_t value) const { return value / scale; }
    /// Returns the most fine units that are not more than `value`, in units of the problem.
    [[nodiscard]] std::uint64_t most(std::uint64_t value) const {
        return value * scale + (scale - 1);
    }
};

/// Computes the reduced cost of a cell with this multiplier for a sensor that meets `multiplicity`
/// of its need: at most the multiplier, rounded up so that bounds hold.
inline std::uint32_t reducedCost(std::uint32_t multiplier, std::uint32_t multiplicity,
                                 std::uint32_t need) {
    if (multiplicity >= need) return multiplier;
    return static_cast<std::uint32_t>((std::uint64_t{multiplier} * multiplicity + need - 1) / need);
}

/// Returns the fraction of a need that a sensor meets.
inline float partOf(std::uint32_t multiplicity, std::uint32_t need) {
    return multiplicity >= need ? 1.0F
                                : static_cast<float>(multiplicity) / static_cast<float>(need);
}

/// The admissible counts of sensors of each kind, each on a different candidate: all ways within
/// `most` and the budget that leave no room for one more of the last kind.
class CountChoice {
  public:
    explicit CountChoice(const Problem& problem);

    /// Returns the maximum count of a kind, over all counts of the others.
    [[nodiscard]] std::size_t most(std::size_t kind) const { return most_[kind]; }
    /// Returns the maximum total count.
    [[nodiscard]] std::size_t total() const { return total_; }
    /// Returns false if there are too many ways to list: then bounds allow fractions of one sensor.
    [[nodiscard]] bool isListed() const { return is_listed_; }
    /// Returns the ways, each a count per kind.
    [[nodiscard]] const std::vector<std::vector<std::size_t>>& ways() const { return ways_; }

    /// The best counts for given reduced costs.
    struct Best {
        std::uint64_t value = 0;          ///< upper bound over all allowed counts
        std::vector<std::size_t> counts;  ///< of each kind, for about that value
        std::vector<std::uint64_t> with;  ///< with[k] + the reduced cost of a candidate of kind k
                                          ///< bounds solutions with that candidate
        std::vector<char> may;            ///< may[k]: one of kind k fits at all
    };
    /// Finds the best counts.
    /// \param sums sums[k][n]: the sum of the n best reduced costs of kind k, n up to most(k)
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

/// Step lengths and averaging of a MultiplierSearch.
struct SearchPace {
    /// Factor of the first step: 1 reaches the target if the bound is linear.
    double factor = 1;
    /// Minimum share of a new subgradient in the average, relative to its maximum.
    double least_part = 0.1;
    /// After so many trials almost without gain the share of new subgradients falls: the average
    /// settles. 0: never.
    int patience = 0;
};
/// For some hundreds of trials: comes nearer to the lowest bound.
constexpr SearchPace kLongPace = {.factor = 1, .least_part = 0.4, .patience = 10};
/// For some tens of trials from a nearly optimal start: longer steps only lead away.
constexpr SearchPace kWarmPace = {.factor = 0.5, .least_part = 0.1, .patience = 0};

/// A search compares its bound with that of so many rounds before, to see whether it stalls.
constexpr int kRoundsBack = 4;

/// Finds the Lagrange multipliers with the lowest bound, trial by trial: the volume algorithm
/// (F. Barahona, R. Anbil, The volume algorithm: producing primal solutions with a subgradient
/// method, 2000), a subgradient method that steps from the best multipliers so far along an average
/// of the subgradients, so that it neither swings between nearly equal sensors nor needs many
/// steps.
class MultiplierSearch {
  public:
    /// \param weights of the cells: the multipliers are from 0 to these
    /// \param start the first trial
    /// \param target a value that the bound will not pass, or about
    MultiplierSearch(std::span<const std::uint32_t> weights, std::vector<std::uint32_t> start,
                     double target, const SearchPace& pace = SearchPace());

    [[nodiscard]] const std::vector<std::uint32_t>& trial() const { return trial_; }
    [[nodiscard]] const std::vector<std::uint32_t>& best() const { return best_; }
    /// Returns the lowest bound reported; infinite before the first report.
    [[nodiscard]] double bound() const { return bound_; }
    /// Stores the result of the trial and computes the next one.
    /// \param cover fraction of each cell's need that the best sensors meet
    void report(double bound, std::span<const float> cover);
    /// Continues from the best multipliers with another bound, since more sensors are available
    /// than in the last trials.
    void restart(double bound, std::span<const float> cover);
    /// Returns the share of the last trial in the average.
    [[nodiscard]] double part() const { return part_; }

  private:
    void settle();
    void step();

    std::span<const std::uint32_t> weights_;
    double target_;
    SearchPace pace_;
    double bound_ = std::numeric_limits<double>::infinity(), settled_ = bound_;
    double factor_, mixing_ = 0.2, part_ = 1;
    bool is_small_;  // all weights are below 2^31
    int failures_ = 0, reports_ = 0;
    std::vector<std::uint32_t> trial_, best_;
    std::vector<float> average_;  // of cover
};

/// Lagrangian relaxation over all candidates: computes reduced costs, finds the best candidates by
/// them, and excludes candidates.
class RootRelaxation {
  public:
    explicit RootRelaxation(const Problem& problem);

    [[nodiscard]] const RelaxedCells& cells() const { return cells_; }
    [[nodiscard]] const CountChoice& counts() const { return counts_; }

    /// Computes initial multipliers from a good solution: the weight of a cell that at most one
    /// sensor sees, 0 for cells that more sensors see.
    [[nodiscard]] std::vector<std::uint32_t> startFrom(const std::vector<Choice>& chosen) const;

    /// Computes the bound for these multipliers over all remaining candidates, or over the working
    /// set, in fine units. The members below refer to the last call.
    std::uint64_t evaluate(const std::vector<std::uint32_t>& multipliers, bool is_all);
    /// Returns the fraction of each cell's need that the best candidates meet.
    [[nodiscard]] const std::vector<float>& cover() const { return cover_; }

    /// After evaluate() of all: reduced-cost fixing, excludes candidates that are in no solution
    /// better than `cut` (fine).
    /// \return an upper bound, at most cut, of solutions with any of them
    std::uint64_t ruleOut(std::uint64_t cut);
    /// After evaluate() of all: adds the sites of the `count` best reduced costs of each kind to
    /// the working set.
    void widen(std::size_t count);
    /// Excludes all others.
    /// \param kept per kind, ascending
    void keepOnly(const std::vector<std::vector<std::uint32_t>>& kept);

    /// Returns, per kind, the remaining candidates.
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> survivors() const;

  private:
    struct OfKind {
        const CandidateSet* candidates = nullptr;
        std::vector<char> is_out;
        std::vector<std::uint32_t> sites, working;  ///< with candidates left; to be weighed
        std::vector<char> is_working;
        std::vector<std::uint32_t> reduced_costs;
        std::vector<std::uint32_t> top;  ///< the best, their number at most counts_.most()
        /// Per site, the highest reduced cost when it was last weighed, less CellCosts::risen of
        /// that moment: a later reduced cost is at most this and the later `risen`.
        std::vector<std::int64_t> least_bounds;
        std::vector<std::uint32_t> weighed;  ///< sites of the last weighTop()
    };
    /// Reduced costs of the cells for one multiplicity.
    struct CellCosts {
        std::vector<std::uint32_t> costs;
        WeightSums sums;
        std::int64_t risen = 0;  ///< sum of all increases of all cells so far
    };

    void setReducedCosts(const std::vector<std::uint32_t>& multipliers);
    void weighSites(std::size_t kind, std::span<const std::uint32_t> sites);
    void weighTop(std::size_t kind, std::size_t count);
    void findTop(std::size_t kind, const std::vector<std::uint32_t>& sites, std::size_t count);
    void setCover();

    const Problem& problem_;
    RelaxedCells cells_;
    CountChoice counts_;
    std::vector<OfKind> kinds_;
    std::vector<CellCosts> cell_costs_;  // per kind; of the first with the same multiplicity
    std::vector<std::size_t> costs_of_;  // kind -> index in cell_costs_
    bool is_met_at_once_ = true;         // every sensor meets the whole need of any cell
    std::vector<std::vector<std::uint64_t>> sums_;
    std::uint64_t free_ = 0;  // the bound without sensors
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
    /// Returns, per kind and ascending, the candidates that may be part of a solution better than
    /// `cut`.
    std::vector<std::vector<std::uint32_t>> survivors;
    std::uint64_t cut = 0;
};

/// When a search for multipliers ends.
struct LagrangeLimits {
    /// A lower bound than this is not required. No solution with this value need exist.
    std::uint64_t cut = 0;
    double gap = 0;   ///< ends once (bound - cut) / bound is at most this
    int rounds = 24;  ///< maximum number of passes over all candidates
    /// Ends once four rounds gain less than this part of the distance between bound and cut.
    double stall = 0.05;
    SearchPace pace = SearchPace();
    /// Multipliers of a similar problem to start from instead, see Bound::multipliers; may be null
    /// or empty.
    const std::vector<std::uint32_t>* start = nullptr;
};

/// Computes an upper bound of max sum w_i y_i subject to required y_i <= achieved_i + sum_j m_j
/// a_ij x_j and 0 <= y <= 1, by Lagrangian relaxation of the cells' rows and a subgradient method
/// that ends at the gap or when progress stalls. Integer arithmetic: the bound is exact.
/// Deterministic for any number of threads.
/// \param near a solution from which initial multipliers are derived
Bound lagrangianBound(const Problem& problem, const std::vector<Choice>& near,
                      const LagrangeLimits& limits, Progress& progress);

}  // namespace ispace
