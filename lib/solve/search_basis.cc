// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/search_basis.h"

#include <algorithm>

namespace ispace {

namespace {

constexpr std::uint64_t kLow = 0xffffffffU;

}  // namespace

std::vector<std::uint32_t> maxOfSites(const CandidateSet& candidates,
                                      std::span<const std::uint32_t> values) {
    std::vector<std::uint32_t> most(candidates.sites());
    for (std::size_t site = 0; site < most.size(); ++site) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(candidates.firstOf(site));
        const auto end = values.begin() + static_cast<std::ptrdiff_t>(candidates.firstOf(site + 1));
        most[site] = *std::max_element(begin, end);
    }
    return most;
}

void CandidateFinder::lookAt(std::size_t site, const CandidateGains& gains,
                             std::span<std::uint32_t> bounds,
                             const std::function<bool(std::size_t)>& allows, BestCandidate& best) {
    const std::size_t begin = gains.candidates->firstOf(site);
    const std::size_t count = gains.candidates->firstOf(site + 1) - begin;
    values_.resize(count);
    gains.candidates->weighSite(site, *gains.first, values_);
    bounds[site] = *std::max_element(values_.begin(), values_.end());
    const bool has_second = gains.second != nullptr;
    const Score most = std::uint64_t{bounds[site]} << 32U | (has_second ? kLow : 0U);
    if (best.is_found && most < best.score) return;
    if (has_second) {
        more_.resize(count);
        gains.candidates->weighSite(site, *gains.second, more_);
    }
    for (std::size_t k = 0; k < count; ++k) {
        const Score score = std::uint64_t{values_[k]} << 32U | (has_second ? more_[k] : 0U);
        const bool is_better = !best.is_found || score > best.score ||
                               (score == best.score && begin + k < best.candidate);
        if (is_better && (!allows || allows(begin + k))) best = {begin + k, score, true};
    }
}

BestCandidate CandidateFinder::find(const CandidateGains& gains, std::span<std::uint32_t> bounds,
                                    const BestCandidate& known,
                                    const std::function<bool(std::size_t)>& allows,
                                    const Progress& progress) {
    BestCandidate best = known;
    const std::uint64_t low = gains.second != nullptr ? kLow : 0U;
    // Among equals only a site that comes before the best one matters.
    const auto may_help = [&](std::uint64_t bound, std::size_t site) {
        const Score most = bound << 32U | low;
        return !best.is_found || most > best.score ||
               (most == best.score && site <= gains.candidates->siteOf(best.candidate));
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
        lookAt(site, gains, bounds, allows, best);
    }
    return best;
}

SearchBasis::SearchBasis(const Problem& of)
    : problem(of), partial_weights(partialWeights(of)), limits(limitsOf(of)) {
    const CoverageState state = emptyState();
    const std::size_t kinds = problem.kinds.size();
    alone.reserve(kinds);
    site_partial.reserve(kinds);
    site_full.reserve(kinds);
    std::vector<std::uint32_t> gains, most;
    for (std::size_t kind = 0; kind < kinds; ++kind) {
        const CandidateSet& candidates = *problem.kinds[kind].candidates;
        std::vector<std::uint32_t>& values = alone.emplace_back(candidates.size());
        state.marginalGains(kind, Measure::Partial, gains);
        candidates.weighAll(WeightSums(gains), values);
        site_partial.push_back(maxOfSites(candidates, values));
        if (problem.required == 1) {
            site_full.push_back(site_partial.back());
            continue;
        }
        // Whatever else is placed, an uncovered cell adds at most its weight.
        for (std::size_t i = 0; i < gains.size(); ++i)
            if (gains[i] > 0 || problem.achieved.empty() || problem.achieved[i] < problem.required)
                gains[i] = problem.weights[i];
        most.resize(candidates.size());
        candidates.weighAll(WeightSums(gains), most);
        site_full.push_back(maxOfSites(candidates, most));
    }
}

}  // namespace ispace
