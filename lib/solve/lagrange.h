// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "solve/relaxation.h"
#include "solve/search.h"

namespace ispace {

/// The relaxation over all candidates: their prices, the best of them, and which are ruled out.
class RootRelaxation {
  public:
    explicit RootRelaxation(const Problem& problem);

    [[nodiscard]] const RelaxedCells& cells() const { return cells_; }
    [[nodiscard]] const CountChoice& counts() const { return counts_; }

    /// Multipliers to begin with, from sensors that are known to be good: full where at most one of
    /// them sees a cell, none where more do.
    [[nodiscard]] std::vector<std::uint32_t> startFrom(const std::vector<Choice>& chosen) const;

    /// The bound for these multipliers over all candidates that are not ruled out (or those of the
    /// working set alone), in fine units; sets what the others below tell.
    std::uint64_t evaluate(const std::vector<std::uint32_t>& multipliers, bool is_all);
    /// How far the sensors that were best meet each cell.
    [[nodiscard]] const std::vector<float>& cover() const { return cover_; }

    /// After evaluate() of all: rules out what cannot be in anything worth more than `cut` (fine).
    /// \return nothing that has one of those now ruled out is worth more than this, at most cut
    std::uint64_t ruleOut(std::uint64_t cut);
    /// After evaluate() of all: the working set is the sites with the `count` best prices of each
    /// kind, and what it was before.
    void widen(std::size_t count);
    /// Rules out all others. \param kept per kind, ascending
    void keepOnly(const std::vector<std::vector<std::uint32_t>>& kept);

    /// Per kind, those not ruled out.
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> survivors() const;

  private:
    struct OfKind {
        const CandidateSet* candidates = nullptr;
        std::vector<char> is_out;
        std::vector<std::uint32_t> sites, working;  ///< with candidates left; to be priced
        std::vector<char> is_working;
        std::vector<std::uint32_t> prices;
        std::vector<std::uint32_t> top;  ///< the best, their number at most counts_.most()
    };

    void setPrices(const std::vector<std::uint32_t>& multipliers);
    void priceSites(std::size_t kind, const std::vector<std::uint32_t>& sites);
    void findTop(std::size_t kind, const std::vector<std::uint32_t>& sites, std::size_t count);
    void setCover();

    const Problem& problem_;
    RelaxedCells cells_;
    CountChoice counts_;
    std::vector<OfKind> kinds_;
    std::vector<CellPrices> prices_;      // per kind; of the first with the same share
    std::vector<std::size_t> prices_of_;  // kind -> index in prices_
    std::vector<std::uint32_t> shared_;   // memory for prices of one share
    std::vector<std::vector<std::uint64_t>> sums_;
    std::uint64_t free_ = 0;  // what the bound is without sensors
    CountChoice::Best best_;
    std::vector<Choice> chosen_;
    std::vector<float> cover_;
};

struct LagrangeLimits {
    /// Only what is worth more than this matters: the bound need not be lower. Something that is
    /// worth this need not exist.
    std::uint64_t cut = 0;
    double gap = 0;   ///< ends where the bound is within that of the cut
    int rounds = 24;  ///< at most, in which all candidates are looked at
};

/// boundByLagrange() with limits. \param near multipliers start from those that suit these choices
Bound boundWithin(const Problem& problem, const std::vector<Choice>& near,
                  const LagrangeLimits& limits, Progress& progress);

}  // namespace ispace
