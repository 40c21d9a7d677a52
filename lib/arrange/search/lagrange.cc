// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/relaxation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "arrange/search/search.h"

namespace ispace {

RootRelaxation::RootRelaxation(const Problem& problem)
    : problem_(problem), cells_(problem), counts_(problem) {
    const std::size_t kinds = problem.kinds.size();
    kinds_.resize(kinds);
    sums_.resize(kinds);
    for (std::size_t k = 0; k < kinds; ++k) {
        kinds_[k].candidates = problem.kinds[k].candidates;
        kinds_[k].reduced_costs.assign(kinds_[k].candidates->size(), 0);
        kinds_[k].is_working.assign(kinds_[k].candidates->sites(), 0);
        kinds_[k].is_out.assign(kinds_[k].candidates->size(), 0);
        kinds_[k].sites.resize(kinds_[k].candidates->sites());
        std::iota(kinds_[k].sites.begin(), kinds_[k].sites.end(), 0U);
        const auto same = std::find(cells_.multiplicities.begin(), cells_.multiplicities.end(),
                                    cells_.multiplicities[k]);
        const auto first = static_cast<std::size_t>(same - cells_.multiplicities.begin());
        sums_of_.push_back(first == k ? reduced_costs_.size() : sums_of_[first]);
        if (first == k) reduced_costs_.emplace_back();
    }
    cover_.resize(problem.cells());
}

void RootRelaxation::keepOnly(const std::vector<std::vector<std::uint32_t>>& kept) {
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        OfKind& own = kinds_[k];
        own.is_out.assign(own.candidates->size(), 1);
        own.sites.clear();
        for (const std::uint32_t i : kept[k]) {
            own.is_out[i] = 0;
            const auto site = static_cast<std::uint32_t>(own.candidates->siteOf(i));
            if (own.sites.empty() || own.sites.back() != site) own.sites.push_back(site);
        }
    }
}

std::vector<std::uint32_t> RootRelaxation::startFrom(const std::vector<Choice>& chosen) const {
    std::vector<std::uint16_t> multiplicities(problem_.cells(), 0);
    for (const Choice& choice : chosen) {
        const std::uint16_t multiplicity = cells_.multiplicities[choice.kind];
        kinds_[choice.kind].candidates->forEachRun(choice.candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i)
                multiplicities[i] = static_cast<std::uint16_t>(multiplicities[i] + multiplicity);
        });
    }
    std::vector<std::uint32_t> multipliers = cells_.weights;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
        if (multiplicities[i] > cells_.needs[i]) multipliers[i] = 0;
    return multipliers;
}

std::uint64_t RootRelaxation::evaluate(const std::vector<std::uint32_t>& multipliers, bool is_all) {
    setReducedCosts(multipliers);
    free_ = cells_.settled;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
        free_ += cells_.weights[i] - multipliers[i];
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        const auto& sites = is_all ? kinds_[k].sites : kinds_[k].working;
        weighSites(k, sites);
        findTop(k, sites, counts_.most(k));
        sums_[k].assign(1, 0);
        for (const std::uint32_t i : kinds_[k].top)
            sums_[k].push_back(sums_[k].back() + kinds_[k].reduced_costs[i]);
    }
    best_ = counts_.best(sums_);
    chosen_.clear();
    for (std::size_t k = 0; k < kinds_.size(); ++k)
        for (std::size_t n = 0; n < best_.counts[k]; ++n) chosen_.push_back({k, kinds_[k].top[n]});
    setCover();
    return free_ + best_.value;
}

void RootRelaxation::setReducedCosts(const std::vector<std::uint32_t>& multipliers) {
    for (std::size_t k = 0, next = 0; k < kinds_.size(); ++k) {
        if (sums_of_[k] != next) continue;
        const std::uint16_t multiplicity = cells_.multiplicities[k];
        shared_.resize(multipliers.size());
        for (std::size_t i = 0; i < multipliers.size(); ++i)
            shared_[i] = reducedCost(multipliers[i], multiplicity, cells_.needs[i]);
        reduced_costs_[next++].assign(shared_);
    }
}

void RootRelaxation::weighSites(std::size_t kind, const std::vector<std::uint32_t>& sites) {
    OfKind& own = kinds_[kind];
    const WeightSums& reduced_costs = reduced_costs_[sums_of_[kind]];
    constexpr std::size_t kGrain = 32;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sites.size(), kGrain),
                      [&](const tbb::blocked_range<std::size_t>& some) {
                          for (std::size_t i = some.begin(); i < some.end(); ++i) {
                              const std::size_t first = own.candidates->firstOf(sites[i]);
                              const std::size_t end = own.candidates->firstOf(sites[i] + 1);
                              own.candidates->weighSite(
                                  sites[i], reduced_costs,
                                  std::span(own.reduced_costs).subspan(first, end - first));
                          }
                      });
}

void RootRelaxation::findTop(std::size_t kind, const std::vector<std::uint32_t>& sites,
                             std::size_t count) {
    OfKind& own = kinds_[kind];
    const auto is_better = [&own](std::uint32_t a, std::uint32_t b) {
        return own.reduced_costs[a] != own.reduced_costs[b]
                   ? own.reduced_costs[a] > own.reduced_costs[b]
                   : a < b;
    };
    // Collects the best in a list that is cut at twice the requested length.
    std::vector<std::uint32_t>& top = own.top;
    top.clear();
    if (count == 0) return;
    const std::size_t room = 2 * count + 64;
    std::uint32_t least = 0;
    const auto cut = [&] {
        if (top.size() <= count) return;
        std::nth_element(top.begin(), top.begin() + static_cast<std::ptrdiff_t>(count - 1),
                         top.end(), is_better);
        top.resize(count);
        least = own.reduced_costs[top[count - 1]];
    };
    for (const std::uint32_t site : sites)
        for (std::size_t i = own.candidates->firstOf(site), end = own.candidates->firstOf(site + 1);
             i < end; ++i) {
            if (own.reduced_costs[i] < least || own.is_out[i] != 0) continue;
            top.push_back(static_cast<std::uint32_t>(i));
            if (top.size() >= room) cut();
        }
    cut();
    std::sort(top.begin(), top.end(), is_better);
}

void RootRelaxation::setCover() {
    std::fill(cover_.begin(), cover_.end(), 0.0F);
    for (const Choice& choice : chosen_) {
        const std::uint16_t multiplicity = cells_.multiplicities[choice.kind];
        kinds_[choice.kind].candidates->forEachRun(choice.candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i)
                cover_[i] += partOf(multiplicity, cells_.needs[i]);
        });
    }
}

std::uint64_t RootRelaxation::ruleOut(std::uint64_t cut) {
    std::uint64_t ruled_out = 0;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        OfKind& own = kinds_[k];
        // With a reduced cost of at most this it is in no better solution.
        const std::uint64_t with = free_ + best_.with[k];
        const std::uint64_t most = cut >= with ? cut - with : 0;
        const bool is_any = best_.may[k] == 0 || cut >= with;
        if (!is_any) continue;
        std::erase_if(own.sites, [&](std::uint32_t site) {
            bool is_empty = true;
            for (std::size_t i = own.candidates->firstOf(site),
                             end = own.candidates->firstOf(site + 1);
                 i < end; ++i) {
                if (own.is_out[i] == 0 && (best_.may[k] == 0 || own.reduced_costs[i] <= most)) {
                    own.is_out[i] = 1;
                    if (best_.may[k] != 0)
                        ruled_out = std::max(ruled_out, with + own.reduced_costs[i]);
                }
                is_empty = is_empty && own.is_out[i] != 0;
            }
            return is_empty;
        });
    }
    return ruled_out;
}

void RootRelaxation::widen(std::size_t count) {
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        OfKind& own = kinds_[k];
        const std::vector<std::uint32_t> best = own.top;
        findTop(k, own.sites, count);
        for (const std::uint32_t i : own.top) own.is_working[own.candidates->siteOf(i)] = 1;
        own.top = best;
        own.working.clear();
        for (const std::uint32_t site : own.sites)
            if (own.is_working[site] != 0) own.working.push_back(site);
    }
}

std::vector<std::vector<std::uint32_t>> RootRelaxation::survivors() const {
    std::vector<std::vector<std::uint32_t>> left(kinds_.size());
    for (std::size_t k = 0; k < kinds_.size(); ++k)
        for (std::size_t i = 0; i < kinds_[k].is_out.size(); ++i)
            if (kinds_[k].is_out[i] == 0) left[k].push_back(static_cast<std::uint32_t>(i));
    return left;
}

namespace {

constexpr int kTrials = 20;     // between two evaluations of all candidates
constexpr int kRoundsBack = 4;  // compared for progress

bool isGood(const Bound& bound, const LagrangeLimits& limits) {
    return static_cast<double>(bound.value - std::min(bound.value, limits.cut)) <=
           limits.gap * static_cast<double>(bound.value);
}

}  // namespace

Bound lagrangianBound(const Problem& problem, const std::vector<Choice>& near,
                      const LagrangeLimits& limits, Progress& progress) {
    RootRelaxation root(problem);
    const RelaxedCells& cells = root.cells();
    Bound bound;
    bound.scale = cells.scale;
    bound.cut = limits.cut;
    bound.value = std::max(problem.totalWeight(), limits.cut);
    bound.multipliers = root.startFrom(near);
    const std::uint64_t cut = cells.most(limits.cut);
    const std::size_t sensors = root.counts().total();
    const std::size_t working = std::clamp<std::size_t>(64 * sensors, 128, 512);
    progress.begin("bounding", limits.rounds);
    MultiplierSearch search(cells.weights, bound.multipliers, static_cast<double>(cut),
                            limits.pace);
    std::vector<std::uint64_t> leasts;  // after each round
    for (int round = 0; round <= limits.rounds && !progress.stopped(); ++round) {
        const std::uint64_t now = root.evaluate(round == 0 ? search.trial() : search.best(), true);
        if (round == 0) {
            search.report(static_cast<double>(now), root.cover());
        } else {
            search.restart(static_cast<double>(now), root.cover());
        }
        if (leasts.empty() || now < leasts.back()) bound.multipliers = search.best();
        leasts.push_back(leasts.empty() ? now : std::min(leasts.back(), now));
        bound.value = std::min(bound.value, std::max(limits.cut, cells.whole(leasts.back())));
        root.ruleOut(cut);
        progress.advance(1);
        noteProgress(problem, limits.cut, bound.value, progress);
        if (isGood(bound, limits) || round == limits.rounds) break;
        // Slower progress leads to no useful bound.
        const std::size_t done = leasts.size();
        if (done > kRoundsBack && leasts.back() < cells.most(problem.totalWeight()) &&
            static_cast<double>(leasts[done - 1 - kRoundsBack] - leasts.back()) <
                limits.stall * static_cast<double>(leasts.back() - cut))
            break;
        root.widen(working);
        for (int trial = 0; trial < kTrials; ++trial) {
            const std::uint64_t value = root.evaluate(search.trial(), false);
            search.report(static_cast<double>(value), root.cover());
        }
    }
    bound.survivors = root.survivors();
    progress.end();
    return bound;
}

}  // namespace ispace
