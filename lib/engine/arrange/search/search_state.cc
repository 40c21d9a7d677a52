// SPDX-License-Identifier: GPL-3.0-or-later
// The multiplicities of cells under the chosen sensors, and the finder of the best candidate.
//
// A sensor is added or removed in the time of the cells that it sees; values are sums of whole
// weights, so removing undoes adding exactly. The finder takes sites from a heap by their bounds
// and ends when the highest bound is below the best score. A score packs the gain and the partial
// gain in 64 bits; of equal scores the first candidate wins, whatever order sites are visited in.
#include "arrange/search/greedy_search.h"
#include "base/simd.h"

#include <algorithm>
#include <limits>

namespace ispace {

namespace {

/// Returns the largest factor of the weights, if they fit, for which their halves, thirds, ...
/// eighths are whole: equal sums of these stay equal.
std::uint32_t stepScaleOf(const Problem& problem) {
    constexpr std::uint32_t kWhole = 840;
    const std::uint64_t most = std::numeric_limits<std::uint32_t>::max() /
                               std::max<std::uint64_t>(1, problem.totalWeight());
    const auto scale = static_cast<std::uint32_t>(most);
    return scale < kWhole ? scale : scale - scale % kWhole;
}

}  // namespace

std::vector<std::uint32_t> partialWeights(const Problem& problem) {
    std::uint64_t most = 1;
    for (const SensorType& kind : problem.kinds)
        most = std::max<std::uint64_t>(
            most, static_cast<std::uint64_t>(std::min(kind.multiplicity, problem.required)));
    std::vector<std::uint32_t> weights = problem.weights;
    const auto sum = [&weights] {
        std::uint64_t all = 0;
        for (const std::uint32_t weight : weights) all += weight;
        return all;
    };
    while (sum() * most >> 32U != 0) {
        // At least 1, until even that is too much.
        const bool is_least = *std::max_element(weights.begin(), weights.end()) <= 1;
        for (std::uint32_t& weight : weights)
            weight = is_least ? weight / 2 : weight / 2 + (weight & 1U);
    }
    return weights;
}

bool takesSteps(const Problem& problem) {
    return std::any_of(problem.kinds.begin(), problem.kinds.end(), [&](const SensorType& kind) {
        return kind.multiplicity < problem.required;
    });
}

std::vector<int> limitsOf(const Problem& problem) {
    std::vector<int> limits;
    limits.reserve(problem.kinds.size());
    for (std::size_t kind = 0; kind < problem.kinds.size(); ++kind) {
        int limit = problem.kinds[kind].most;
        if (!problem.order.empty())
            limit = std::min(limit, static_cast<int>(std::count(problem.order.begin(),
                                                                problem.order.end(), kind)));
        limits.push_back(problem.kinds[kind].candidates->size() == 0 ? 0 : limit);
    }
    return limits;
}

CoverageState::CoverageState(const Problem& problem, const std::vector<std::uint32_t>& partial)
    : problem_(&problem),
      partial_weights_(&partial),
      required_(static_cast<std::uint32_t>(problem.required)),
      step_scale_(stepScaleOf(problem)) {
    multiplicities_.reserve(problem.kinds.size());
    for (const SensorType& kind : problem.kinds)
        multiplicities_.push_back(
            static_cast<std::uint32_t>(std::min(kind.multiplicity, problem.required)));
    clear();
}

void CoverageState::clear() {
    chosen_.clear();
    times_.assign(problem_->kinds.size(), {});
    counts_.assign(problem_->kinds.size(), 0);
    loads_.assign(problem_->cells(), 0);
    value_ = partial_value_ = 0;
    for (std::size_t i = 0; i < loads_.size(); ++i) {
        if (!problem_->achieved.empty())
            loads_[i] = std::min<std::uint32_t>(problem_->achieved[i], required_);
        if (loads_[i] >= required_) value_ += problem_->weights[i];
        partial_value_ += std::uint64_t{(*partial_weights_)[i]} * loads_[i];
    }
}

template <bool kAdds>
void CoverageState::change(const Choice& choice) {
    const std::uint32_t multiplicity = multiplicities_[choice.kind], required = required_;
    const std::uint32_t *weights = problem_->weights.data(), *parts = partial_weights_->data();
    std::uint32_t* loads = loads_.data();
    // The first sensor that sees a cell, or the last one, decides.
    const auto change_single = [&](const CellRun& run) {
        std::uint64_t value = 0, partial = 0;
        for (std::uint32_t cell = run.first; cell < run.end; ++cell) {
            const std::uint32_t counts = loads[cell] == (kAdds ? 0 : multiplicity) ? ~0U : 0;
            value += weights[cell] & counts;
            partial += parts[cell] & counts;
            loads[cell] = kAdds ? loads[cell] + multiplicity : loads[cell] - multiplicity;
        }
        value_ = kAdds ? value_ + value : value_ - value;
        partial_value_ = kAdds ? partial_value_ + partial : partial_value_ - partial;
    };
    const auto change_run = [&](const CellRun& run) {
        for (std::uint32_t cell = run.first; cell < run.end; ++cell) {
            const std::uint32_t less = kAdds ? loads_[cell] : loads_[cell] - multiplicity;
            const std::uint32_t more = less + multiplicity;
            const std::uint64_t value =
                less < required && more >= required ? problem_->weights[cell] : 0;
            const std::uint64_t parts = std::uint64_t{(*partial_weights_)[cell]} *
                                        (std::min(more, required) - std::min(less, required));
            loads_[cell] = kAdds ? more : less;
            value_ = kAdds ? value_ + value : value_ - value;
            partial_value_ = kAdds ? partial_value_ + parts : partial_value_ - parts;
        }
    };
    const CandidateSet& candidates = *problem_->kinds[choice.kind].candidates;
    if (required == 1)
        candidates.forEachRun(choice.candidate, change_single);
    else
        candidates.forEachRun(choice.candidate, change_run);
}

void CoverageState::insert(std::size_t position, const Choice& choice) {
    if (++times_[choice.kind][choice.candidate] == 1) change<true>(choice);
    ++counts_[choice.kind];
    chosen_.insert(chosen_.begin() + static_cast<std::ptrdiff_t>(position), choice);
}

void CoverageState::removeAt(std::size_t position) {
    const Choice choice = chosen_[position];
    chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(position));
    --counts_[choice.kind];
    const auto times = times_[choice.kind].find(choice.candidate);
    if (--times->second > 0) return;
    times_[choice.kind].erase(times);
    change<false>(choice);
}

bool CoverageState::holds(const Choice& choice) const {
    return times_[choice.kind].contains(choice.candidate);
}

double CoverageState::cost() const { return costOf(*problem_, chosen_); }

bool CoverageState::canTake(std::size_t kind, int limit) const {
    return counts_[kind] < limit &&
           (!problem_->budget || isAffordable(*problem_, cost() + problem_->kinds[kind].cost));
}

namespace {

/// Sets the weights of the cells that so much more completes; 0 for the others.
ISPACE_SIMD_CLONES void setCompleted(const std::uint32_t* loads, std::uint32_t more,
                                     std::uint32_t required, const std::uint32_t* weights,
                                     std::uint32_t* gains, std::size_t cells) {
    for (std::size_t i = 0; i < cells; ++i)
        gains[i] = ((loads[i] < required) & (loads[i] + more >= required)) ? weights[i] : 0;
}

}  // namespace

void CoverageState::marginalGains(std::size_t kind, Measure measure,
                                  std::vector<std::uint32_t>& gains) const {
    const std::size_t cells = loads_.size();
    const std::uint32_t multiplicity = multiplicities_[kind], required = required_;
    gains.resize(cells);
    if (measure == Measure::Full) {
        setCompleted(loads_.data(), multiplicity, required, problem_->weights.data(), gains.data(),
                     cells);
    } else {
        const std::uint32_t* weights = partial_weights_->data();
        for (std::size_t i = 0; i < cells; ++i)
            gains[i] = weights[i] * (std::min(loads_[i] + multiplicity, required) -
                                     std::min(loads_[i], required));
    }
}

void CoverageState::stepGains(std::size_t kind, std::uint64_t to_come,
                              std::vector<std::uint32_t>& gains) const {
    const std::uint32_t multiplicity = multiplicities_[kind];
    gains.resize(loads_.size());
    for (std::size_t i = 0; i < gains.size(); ++i) {
        const std::uint32_t lack = required_ - std::min(loads_[i], required_);
        const bool is_in_vain = lack == 0 || lack > multiplicity + to_come;
        const std::uint32_t steps = lack / multiplicity + (lack % multiplicity != 0 ? 1U : 0U);
        gains[i] = is_in_vain ? 0 : problem_->weights[i] * step_scale_ / steps;
    }
}

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

void CandidateFinder::visit(std::size_t site, const CandidateGains& gains,
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
    // Among equals only a site before the best one matters.
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
        visit(site, gains, bounds, allows, best);
    }
    return best;
}

void SearchBasis::addBlocks() {
    for (const SensorType& kind : problem.kinds)
        site_blocks.emplace_back(problem, *kind.candidates);
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
        // Regardless of later sensors, an uncovered cell adds at most its weight.
        for (std::size_t i = 0; i < gains.size(); ++i)
            if (gains[i] > 0 || problem.achieved.empty() || problem.achieved[i] < problem.required)
                gains[i] = problem.weights[i];
        most.resize(candidates.size());
        candidates.weighAll(WeightSums(gains), most);
        site_full.push_back(maxOfSites(candidates, most));
    }
}

}  // namespace ispace
