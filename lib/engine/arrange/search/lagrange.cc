// SPDX-License-Identifier: GPL-3.0-or-later
// The Lagrangian bound of a whole problem, by working sets.
//
// Rounds evaluate all candidates; the trials between them evaluate the sites that were best in
// earlier rounds. Of these, a trial weighs the best of the last one, and then sites that their last
// weight plus all rises of cell costs since then does not exclude. Only rounds yield bounds and
// exclude candidates. Ends when bound and value are near, progress is slow, or the rounds are used
// up.
#include "arrange/search/relaxation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "arrange/search/search.h"
#include "base/simd.h"

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
        costs_of_.push_back(first == k ? cell_costs_.size() : costs_of_[first]);
        if (first == k) cell_costs_.emplace_back().costs.resize(problem.cells());
        kinds_[k].least_bounds.resize(kinds_[k].candidates->sites());
        is_met_at_once_ = is_met_at_once_ &&
                          std::all_of(cells_.needs.begin(), cells_.needs.end(),
                                      [&](auto need) { return need <= cells_.multiplicities[k]; });
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

/// Cells that the solution sees more often than needed do not gain by one more sensor: they
/// begin with 0, the others with their weight.
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

/// Only with is_all an upper bound. Ties go to the smaller index.
std::uint64_t RootRelaxation::evaluate(const std::vector<std::uint32_t>& multipliers, bool is_all) {
    setReducedCosts(multipliers);
    free_ = cells_.settled;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
        free_ += cells_.weights[i] - multipliers[i];
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        if (is_all) {
            weighSites(k, kinds_[k].sites);
            findTop(k, kinds_[k].sites, counts_.most(k));
        } else {
            weighTop(k, counts_.most(k));
        }
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

namespace {

/// Replaces the costs of cells; returns the sum of the increases.
ISPACE_SIMD_CLONES std::uint64_t replace(const std::uint32_t* now, std::uint32_t* costs,
                                         std::size_t cells) {
    std::uint64_t risen = 0;
    for (std::size_t i = 0; i < cells; ++i) {
        risen += std::max(now[i], costs[i]) - costs[i];
        costs[i] = now[i];
    }
    return risen;
}

}  // namespace

/// Kinds of equal multiplicity share cell costs. `risen` sums all rises so far: a site that was
/// weighed before is worth at most its value then plus the rises since.
void RootRelaxation::setReducedCosts(const std::vector<std::uint32_t>& multipliers) {
    std::vector<std::uint32_t> costs;
    for (std::size_t k = 0, next = 0; k < kinds_.size(); ++k) {
        if (costs_of_[k] != next) continue;
        CellCosts& own = cell_costs_[next++];
        const std::uint32_t* now = multipliers.data();
        if (!is_met_at_once_) {
            costs.resize(multipliers.size());
            for (std::size_t i = 0; i < costs.size(); ++i)
                costs[i] = reducedCost(multipliers[i], cells_.multiplicities[k], cells_.needs[i]);
            now = costs.data();
        }
        own.risen += static_cast<std::int64_t>(replace(now, own.costs.data(), own.costs.size()));
        own.sums.assign(own.costs);
    }
}

/// Each site writes its values only, so threads need no order.
void RootRelaxation::weighSites(std::size_t kind, std::span<const std::uint32_t> sites) {
    OfKind& own = kinds_[kind];
    const CellCosts& costs = cell_costs_[costs_of_[kind]];
    constexpr std::size_t kGrain = 32;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sites.size(), kGrain),
                      [&](const tbb::blocked_range<std::size_t>& some) {
                          for (std::size_t i = some.begin(); i < some.end(); ++i) {
                              const std::size_t first = own.candidates->firstOf(sites[i]);
                              const std::size_t end = own.candidates->firstOf(sites[i] + 1);
                              const std::span values =
                                  std::span(own.reduced_costs).subspan(first, end - first);
                              own.candidates->weighSite(sites[i], costs.sums, values);
                              own.least_bounds[sites[i]] =
                                  *std::max_element(values.begin(), values.end()) - costs.risen;
                          }
                      });
}

/// Finds the best of the working set: weighs the sites of the last best ones, then those that
/// their bounds do not exclude.
void RootRelaxation::weighTop(std::size_t kind, std::size_t count) {
    OfKind& own = kinds_[kind];
    std::vector<std::uint32_t>& weighed = own.weighed;
    weighed.clear();
    for (const std::uint32_t i : own.top)
        if (const std::size_t site = own.candidates->siteOf(i); own.is_working[site] != 0)
            weighed.push_back(static_cast<std::uint32_t>(site));
    std::sort(weighed.begin(), weighed.end());
    weighed.erase(std::unique(weighed.begin(), weighed.end()), weighed.end());
    const std::size_t known = weighed.size();
    weighSites(kind, weighed);
    findTop(kind, weighed, count);
    if (count == 0) return;
    const std::int64_t least =
        own.top.size() < count ? 0 : std::int64_t{own.reduced_costs[own.top.back()]};
    const std::int64_t risen = cell_costs_[costs_of_[kind]].risen;
    for (const std::uint32_t site : own.working)
        if (own.least_bounds[site] + risen >= least &&
            !std::binary_search(weighed.begin(),
                                weighed.begin() + static_cast<std::ptrdiff_t>(known), site))
            weighed.push_back(site);
    if (weighed.size() == known) return;
    weighSites(kind, std::span(weighed).subspan(known));
    findTop(kind, weighed, count);
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

/// The subgradient: how often the chosen sensors see each cell, in parts of what it needs.
void RootRelaxation::setCover() {
    std::fill(cover_.begin(), cover_.end(), 0.0F);
    for (const Choice& choice : chosen_) {
        const std::uint16_t multiplicity = cells_.multiplicities[choice.kind];
        kinds_[choice.kind].candidates->forEachRun(choice.candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i)
                cover_[i] += is_met_at_once_ ? 1.0F : partOf(multiplicity, cells_.needs[i]);
        });
    }
}

/// A site leaves the list once all of its candidates are excluded; later rounds are faster.
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

/// Sites never leave the working set, unless all of their candidates are excluded.
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

constexpr int kTrialsPerPass = 20;  // between two evaluations of all candidates

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
    if (limits.start != nullptr && limits.start->size() == problem.cells()) {
        bound.multipliers = *limits.start;
        for (std::size_t i = 0; i < problem.cells(); ++i)
            bound.multipliers[i] = std::min(bound.multipliers[i], cells.weights[i]);
    } else {
        bound.multipliers = root.startFrom(near);
    }
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
        for (int trial = 0; trial < kTrialsPerPass; ++trial) {
            const std::uint64_t value = root.evaluate(search.trial(), false);
            search.report(static_cast<double>(value), root.cover());
        }
    }
    bound.survivors = root.survivors();
    progress.end();
    return bound;
}

}  // namespace ispace
