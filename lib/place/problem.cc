// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/problem.h"

#include <algorithm>
#include <numeric>

#include "place/connection.h"

namespace ispace {

namespace {

/// Each choice once.
std::vector<Choice> distinct(std::vector<Choice> chosen) {
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
}

}  // namespace

std::uint64_t Problem::totalWeight() const {
    return std::accumulate(weights.begin(), weights.end(), std::uint64_t{0});
}

std::uint64_t valueOf(const Problem& problem, const std::vector<Choice>& chosen) {
    // Differences of what is met from cell to cell, so that a run costs two writes.
    std::vector<std::int64_t> steps(problem.cells() + 1, 0);
    for (const Choice& choice : distinct(chosen)) {
        const Kind& kind = problem.kinds[choice.kind];
        kind.candidates->forEachRun(choice.candidate, [&](const CellRun& run) {
            steps[run.first] += kind.share;
            steps[run.end] -= kind.share;
        });
    }
    std::uint64_t value = 0;
    std::int64_t shares = 0;
    for (std::size_t i = 0; i < problem.cells(); ++i) {
        shares += steps[i];
        const std::int64_t met = problem.met.empty() ? 0 : problem.met[i];
        if (met + shares >= problem.demand) value += problem.weights[i];
    }
    return value;
}

double costOf(const Problem& problem, const std::vector<Choice>& chosen) {
    double cost = 0;
    for (const Choice& choice : chosen) cost += problem.kinds[choice.kind].cost;
    return cost;
}

bool isFeasible(const Problem& problem, const std::vector<Choice>& chosen) {
    std::vector<int> counts(problem.kinds.size(), 0);
    for (const Choice& choice : chosen)
        if (++counts[choice.kind] > problem.kinds[choice.kind].most) return false;
    if (problem.budget && !isAffordable(problem, costOf(problem, chosen))) return false;
    return !problem.is_connected || isConnected(problem, chosen);
}

bool isAffordable(const Problem& problem, double cost) {
    // Costs are sums of decimal numbers: 0.1 + 0.2 is to fit 0.3.
    constexpr double kSlack = 1e-9;
    return !problem.budget || cost <= *problem.budget * (1 + kSlack);
}

bool isConnected(const Problem& problem, const std::vector<Choice>& chosen) {
    return Connection(problem, chosen).parts() <= 1;
}

}  // namespace ispace
