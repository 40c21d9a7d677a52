// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/search_basis.h"

#include "solve/best_place.h"

namespace ispace {

SearchBasis::SearchBasis(const Problem& of)
    : problem(of), part_weights(weightsOfParts(of)), limits(limitsOf(of)) {
    const CoverageState state = emptyState();
    const std::size_t kinds = problem.kinds.size();
    alone.reserve(kinds);
    site_parts.reserve(kinds);
    site_met.reserve(kinds);
    std::vector<std::uint32_t> prices, most;
    for (std::size_t kind = 0; kind < kinds; ++kind) {
        const CandidateSet& candidates = *problem.kinds[kind].candidates;
        std::vector<std::uint32_t>& values = alone.emplace_back(candidates.size());
        state.price(kind, Measure::Parts, prices);
        candidates.priceAll(CellPrices(prices), values);
        site_parts.push_back(mostOfSites(candidates, values));
        if (problem.demand == 1) {
            site_met.push_back(site_parts.back());
            continue;
        }
        // Whatever else is placed, a cell that is not met yet adds its weight at most.
        for (std::size_t i = 0; i < prices.size(); ++i)
            if (prices[i] > 0 || problem.met.empty() || problem.met[i] < problem.demand)
                prices[i] = problem.weights[i];
        most.resize(candidates.size());
        candidates.priceAll(CellPrices(prices), most);
        site_met.push_back(mostOfSites(candidates, most));
    }
}

}  // namespace ispace
