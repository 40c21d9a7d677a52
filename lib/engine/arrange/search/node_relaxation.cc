// SPDX-License-Identifier: GPL-3.0-or-later
// The Lagrangian bound of a node. With multipliers m <= w of cells, no solution exceeds
//
//     settled + sum (w - m) + the best reduced costs of each group, as many as it has sensors
//
// where a reduced cost is the sum of m over the cells in view, in parts where several sensors are
// needed. Whole numbers, rounded up. evaluate() weighs all candidates and returns a bound;
// evaluateWorking() weighs a few promising sites, and returns a number that may be below it: it
// only tells whether a full evaluation is worth its time.
#include "arrange/search/branch_node.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace ispace {

NodeRelaxation::NodeRelaxation(const BranchNode& node)
    : problem_(*node.problem), cover_(problem_.cells()) {
    groups_.reserve(node.groups.size());
    for (const BranchGroup& group : node.groups)
        groups_.push_back({group.kind, group.count, *group.list});
    settle(node.pending);
    reduced_costs_.reserve(problem_.kinds.size());
    for (const auto& kind : problem_.kinds)
        reduced_costs_.emplace_back(kind.candidates->size(), 0U);
    top_.resize(groups_.size());
    frequencies_.reserve(groups_.size());
    for (const OpenGroup& group : groups_) frequencies_.emplace_back(group.list.size(), 0.0F);
    findSites();
}

/// Taken sensors settle the cells that they complete; of other cells fewer sensors are needed.
void NodeRelaxation::settle(const std::vector<Choice>& chosen) {
    for (const Choice& choice : chosen) {
        const ReducedProblem::OfKind& kind = problem_.kinds[choice.kind];
        kind.candidates->forEachRun(choice.candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i) {
                if (problem_.needs[i] > kind.multiplicity) {
                    problem_.needs[i] =
                        static_cast<std::uint16_t>(problem_.needs[i] - kind.multiplicity);
                    continue;
                }
                problem_.settled += problem_.weights[i];
                problem_.weights[i] = 0;
                problem_.needs[i] = 1;
            }
        });
    }
}

void NodeRelaxation::findSites() {
    sites_.assign(problem_.kinds.size(), {});
    for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
        const CandidateSet& set = *problem_.kinds[k].candidates;
        std::vector<char> is_open(set.sites(), 0);
        for (const OpenGroup& group : groups_) {
            if (group.kind != k) continue;
            for (const std::uint32_t i : group.list) is_open[set.siteOf(i)] = 1;
        }
        for (std::uint32_t site = 0; site < is_open.size(); ++site)
            if (is_open[site] != 0) sites_[k].push_back(site);
    }
}

/// Any multipliers of at most the weights give a bound; those of the parent are near the best.
std::vector<std::uint32_t> NodeRelaxation::start(const BranchNode& node) const {
    std::vector<std::uint32_t> multipliers = *node.multipliers;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
        multipliers[i] = std::min(multipliers[i], problem_.weights[i]);
    return multipliers;
}

void NodeRelaxation::weigh(const std::vector<std::uint32_t>& multipliers, const PerKind& sites) {
    WeightSums reduced_costs;
    std::uint32_t last_multiplicity = 0;
    for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
        if (sites[k].empty()) continue;
        const ReducedProblem::OfKind& kind = problem_.kinds[k];
        if (kind.multiplicity != last_multiplicity) {
            cell_costs_.resize(multipliers.size());
            for (std::size_t i = 0; i < multipliers.size(); ++i)
                cell_costs_[i] = reducedCost(multipliers[i], kind.multiplicity, problem_.needs[i]);
            reduced_costs.assign(cell_costs_);
            last_multiplicity = kind.multiplicity;
        }
        // The node's work is split among threads, too: there may be few nodes, but large ones.
        constexpr std::size_t kGrain = 256;
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sites[k].size(), kGrain),
                          [&](const tbb::blocked_range<std::size_t>& some) {
                              for (std::size_t i = some.begin(); i < some.end(); ++i) {
                                  const std::uint32_t site = sites[k][i];
                                  const std::size_t first = kind.candidates->firstOf(site);
                                  const std::size_t end = kind.candidates->firstOf(site + 1);
                                  kind.candidates->weighSite(
                                      site, reduced_costs,
                                      std::span(reduced_costs_[k]).subspan(first, end - first));
                              }
                          });
    }
}

std::uint64_t NodeRelaxation::evaluate(const std::vector<std::uint32_t>& multipliers) {
    weigh(multipliers, sites_);
    return findBest(multipliers, true);
}

std::uint64_t NodeRelaxation::evaluateWorking(const std::vector<std::uint32_t>& multipliers) {
    weigh(multipliers, working_sites_);
    return findBest(multipliers, false);
}

/// Returns the candidates of a group with the best reduced costs.
std::vector<std::uint32_t> NodeRelaxation::mostPromising(const OpenGroup& group,
                                                         std::size_t count) const {
    const std::vector<std::uint32_t>& reduced_costs = reduced_costs_[group.kind];
    std::vector<std::uint32_t> best(std::min(count, group.list.size()));
    std::partial_sort_copy(group.list.begin(), group.list.end(), best.begin(), best.end(),
                           [&](std::uint32_t a, std::uint32_t b) {
                               return reduced_costs[a] != reduced_costs[b]
                                          ? reduced_costs[a] > reduced_costs[b]
                                          : a < b;
                           });
    return best;
}

/// Working sites only accumulate, so a working bound comes closer to that of all.
void NodeRelaxation::widen() {
    constexpr std::size_t kMinValue = 24, kPerSensor = 8;
    if (is_working_.empty())
        for (const auto& kind : problem_.kinds)
            is_working_.emplace_back(kind.candidates->sites(), 0);
    for (const OpenGroup& group : groups_) {
        const CandidateSet& set = *problem_.kinds[group.kind].candidates;
        for (const std::uint32_t i : mostPromising(group, kMinValue + kPerSensor * group.count))
            is_working_[group.kind][set.siteOf(i)] = 1;
    }
    working_sites_.assign(sites_.size(), {});
    for (std::size_t k = 0; k < sites_.size(); ++k)
        for (const std::uint32_t site : sites_[k])
            if (is_working_[k][site] != 0) working_sites_[k].push_back(site);
    working_.assign(groups_.size(), {});
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        const CandidateSet& set = *problem_.kinds[groups_[g].kind].candidates;
        for (const std::uint32_t i : groups_[g].list)
            if (is_working_[groups_[g].kind][set.siteOf(i)] != 0) working_[g].push_back(i);
    }
}

/// Keeps one candidate more than a group has sensors: takeForced() tells by it what a replacement
/// gains. Ties go to the smaller index, for repeatable trees.
std::uint64_t NodeRelaxation::findBest(const std::vector<std::uint32_t>& multipliers, bool is_all) {
    free_ = problem_.settled;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
        free_ += problem_.weights[i] - multipliers[i];
    bound_ = free_;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        const OpenGroup& group = groups_[g];
        const std::vector<std::uint32_t>& reduced_costs = reduced_costs_[group.kind];
        const auto is_better = [&reduced_costs](std::uint32_t a, std::uint32_t b) {
            return reduced_costs[a] != reduced_costs[b] ? reduced_costs[a] > reduced_costs[b]
                                                        : a < b;
        };
        const std::vector<std::uint32_t>& list = is_all ? group.list : working_[g];
        top_[g].resize(std::min(group.count + 1, list.size()));
        std::partial_sort_copy(list.begin(), list.end(), top_[g].begin(), top_[g].end(), is_better);
        for (std::size_t n = 0; n < std::min(group.count, top_[g].size()); ++n)
            bound_ += reduced_costs[top_[g][n]];
    }
    setCover();
    return bound_;
}

void NodeRelaxation::setCover() {
    std::fill(cover_.begin(), cover_.end(), 0.0F);
    for (const Choice& choice : chosen()) {
        const ReducedProblem::OfKind& kind = problem_.kinds[choice.kind];
        kind.candidates->forEachRun(choice.candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i)
                cover_[i] += partOf(kind.multiplicity, problem_.needs[i]);
        });
    }
}

std::vector<Choice> NodeRelaxation::chosen() const {
    std::vector<Choice> chosen;
    for (std::size_t g = 0; g < groups_.size(); ++g)
        for (std::size_t n = 0; n < std::min(groups_[g].count, top_[g].size()); ++n)
            chosen.push_back({groups_[g].kind, top_[g][n]});
    return chosen;
}

/// \pre evaluate() came last: evaluateWorking() leaves old reduced costs of other sites
void NodeRelaxation::ruleOut(std::uint64_t cut) {
    bool is_any = false;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        OpenGroup& group = groups_[g];
        if (group.list.size() <= group.count) continue;
        // A candidate outside the best replaces the last of them.
        const std::vector<std::uint32_t>& reduced_costs = reduced_costs_[group.kind];
        const std::uint64_t without = bound_ - reduced_costs[top_[g][group.count - 1]];
        if (without > cut) continue;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < group.list.size(); ++i) {
            const std::uint32_t candidate = group.list[i];
            const bool is_best =
                std::find(top_[g].begin(), top_[g].end() - 1, candidate) != top_[g].end() - 1;
            if (!is_best && without + reduced_costs[candidate] <= cut) {
                ruled_out_ = std::max(ruled_out_, without + reduced_costs[candidate]);
                continue;
            }
            group.list[kept] = candidate;
            frequencies_[g][kept++] = frequencies_[g][i];
        }
        is_any = is_any || kept < group.list.size();
        group.list.resize(kept);
        frequencies_[g].resize(kept);
    }
    if (is_any) findSites();
}

/// A candidate is forced if the next best in its place leaves no more than the cut.
std::vector<Choice> NodeRelaxation::takeForced(std::uint64_t cut) {
    std::vector<Choice> forced;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        OpenGroup& group = groups_[g];
        const std::vector<std::uint32_t>& reduced_costs = reduced_costs_[group.kind];
        const std::size_t best = std::min(group.count, top_[g].size());
        const std::uint64_t next = top_[g].size() > best ? reduced_costs[top_[g][best]] : 0;
        for (std::size_t n = 0; n < best; ++n) {
            const std::uint32_t candidate = top_[g][n];
            const std::uint64_t without = bound_ - reduced_costs[candidate] + next;
            if (without > cut) continue;
            ruled_out_ = std::max(ruled_out_, without);
            forced.push_back({group.kind, candidate});
            --group.count;
            const auto at = std::lower_bound(group.list.begin(), group.list.end(), candidate);
            frequencies_[g].erase(frequencies_[g].begin() + (at - group.list.begin()));
            group.list.erase(at);
        }
        if (group.count == 0) {
            group.list.clear();
            frequencies_[g].clear();
        }
    }
    return forced;
}

NodeCore NodeRelaxation::core(std::size_t size) const {
    constexpr std::size_t kMinValue = 16;
    constexpr float kRare = 1e-3F;
    std::size_t sensors = 0;
    for (const OpenGroup& group : groups_) sensors += group.count;
    NodeCore is_core;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        const OpenGroup& group = groups_[g];
        std::vector<char>& own = is_core.emplace_back(group.list.size(), 0);
        const std::size_t part = size * group.count / std::max<std::size_t>(sensors, 1);
        for (const std::uint32_t i : mostPromising(group, kMinValue + part)) {
            const auto at = std::lower_bound(group.list.begin(), group.list.end(), i);
            own[static_cast<std::size_t>(at - group.list.begin())] = 1;
        }
        for (std::size_t i = 0; i < own.size(); ++i)
            if (frequencies_[g][i] > kRare) own[i] = 1;
    }
    return is_core;
}

void NodeRelaxation::count(float part) {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        for (float& frequency : frequencies_[g]) frequency *= 1.0F - part;
        const auto& list = groups_[g].list;
        for (std::size_t n = 0; n < std::min(groups_[g].count, top_[g].size()); ++n) {
            const auto at = std::lower_bound(list.begin(), list.end(), top_[g][n]);
            if (at != list.end() && *at == top_[g][n])
                frequencies_[g][static_cast<std::size_t>(at - list.begin())] += part;
        }
    }
}

std::vector<float> NodeRelaxation::likeness(std::size_t group, std::uint32_t pivot,
                                            const std::vector<std::uint32_t>& multipliers) {
    const OpenGroup& own = groups_[group];
    weigh(multipliers, sites_);
    const std::vector<std::uint32_t> sizes = reduced_costs_[own.kind];
    std::vector<std::uint32_t> seen(multipliers.size(), 0);
    problem_.kinds[own.kind].candidates->forEachRun(pivot, [&](const CellRun& run) {
        for (std::uint32_t i = run.first; i < run.end; ++i) seen[i] = multipliers[i];
    });
    weigh(seen, sites_);
    std::vector<float> likeness;
    likeness.reserve(own.list.size());
    for (const std::uint32_t i : own.list) {
        const std::uint32_t larger = std::max({sizes[i], sizes[pivot], 1U});
        likeness.push_back(static_cast<float>(reduced_costs_[own.kind][i]) /
                           static_cast<float>(larger));
    }
    return likeness;
}

}  // namespace ispace
