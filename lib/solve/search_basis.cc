// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/search_basis.h"

#include <algorithm>

namespace ispace {

namespace {

constexpr std::uint64_t kLow = 0xffffffffU;

}  // namespace

std::vector<std::uint32_t> mostOfSites(const CandidateSet& candidates,
                                       std::span<const std::uint32_t> values) {
    std::vector<std::uint32_t> most(candidates.sites());
    for (std::size_t site = 0; site < most.size(); ++site) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(candidates.firstOf(site));
        const auto end = values.begin() + static_cast<std::ptrdiff_t>(candidates.firstOf(site + 1));
        most[site] = *std::max_element(begin, end);
    }
    return most;
}

void PlaceFinder::lookAt(std::size_t site, const PlacePrices& prices,
                         std::span<std::uint32_t> bounds,
                         const std::function<bool(std::size_t)>& allows, BestPlace& best) {
    const std::size_t begin = prices.candidates->firstOf(site);
    const std::size_t count = prices.candidates->firstOf(site + 1) - begin;
    values_.resize(count);
    prices.candidates->priceSite(site, *prices.first, values_);
    bounds[site] = *std::max_element(values_.begin(), values_.end());
    const bool has_second = prices.second != nullptr;
    const Score most = std::uint64_t{bounds[site]} << 32U | (has_second ? kLow : 0U);
    if (best.is_found && most < best.score) return;
    if (has_second) {
        more_.resize(count);
        prices.candidates->priceSite(site, *prices.second, more_);
    }
    for (std::size_t k = 0; k < count; ++k) {
        const Score score = std::uint64_t{values_[k]} << 32U | (has_second ? more_[k] : 0U);
        const bool is_better = !best.is_found || score > best.score ||
                               (score == best.score && begin + k < best.candidate);
        if (is_better && (!allows || allows(begin + k))) best = {begin + k, score, true};
    }
}

BestPlace PlaceFinder::find(const PlacePrices& prices, std::span<std::uint32_t> bounds,
                            const BestPlace& known, const std::function<bool(std::size_t)>& allows,
                            const Progress& progress) {
    BestPlace best = known;
    const std::uint64_t low = prices.second != nullptr ? kLow : 0U;
    // Among equals only a site that comes before the best one matters.
    const auto may_help = [&](std::uint64_t bound, std::size_t site) {
        const Score most = bound << 32U | low;
        return !best.is_found || most > best.score ||
               (most == best.score && site <= prices.candidates->siteOf(best.candidate));
    };
    queue_.clear();
    for (std::size_t site = 0; site < bounds.size(); ++site)
        if (may_help(bounds[site], site))
            queue_.push_back(std::uint64_t{bounds[site]} << 32U | (kLow - site));
    std::make_heap(queue_.begin(), queue_.end());
    while (!queue_.empty()) {
        std::pop_heap(queue_.begin(), queue_.end());
        const std::uint64_t top = queue_.back();
        queue_.pop_back();
        const std::size_t site = kLow - (top & kLow);
        if (!may_help(top >> 32U, site) || (best.is_found && progress.stopped())) break;
        lookAt(site, prices, bounds, allows, best);
    }
    return best;
}

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
