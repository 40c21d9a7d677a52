// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "solve/relaxation.h"
#include "solve/search.h"

namespace ispace {

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
