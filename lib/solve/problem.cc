// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/problem.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>

#include "solve/connection.h"

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
    // Kind by kind there are few sums to round.
    double cost = 0;
    for (std::size_t k = 0; k < problem.kinds.size(); ++k) {
        const auto count = std::count_if(chosen.begin(), chosen.end(),
                                         [k](const Choice& choice) { return choice.kind == k; });
        cost += static_cast<double>(count) * problem.kinds[k].cost;
    }
    return cost;
}

bool isFeasible(const Problem& problem, const std::vector<Choice>& chosen) {
    std::vector<int> counts(problem.kinds.size(), 0);
    for (const Choice& choice : chosen)
        if (++counts[choice.kind] > problem.kinds[choice.kind].most) return false;
    if (problem.budget && !isAffordable(problem, costOf(problem, chosen))) return false;
    return !problem.is_connected || isConnected(problem, chosen);
}

bool isCheaper(double cost, double than) {
    constexpr double kSlack = 1e-13;
    return cost < than * (1 - kSlack);
}

bool isAffordable(const Problem& problem, double cost) {
    return !problem.budget || !isCheaper(*problem.budget, cost);
}

std::size_t affordableCount(double budget, double spent, double cost, std::size_t most) {
    std::size_t least = 0;
    while (least < most) {
        const std::size_t middle = most - (most - least) / 2;
        if (isCheaper(budget, spent + static_cast<double>(middle) * cost))
            most = middle - 1;
        else
            least = middle;
    }
    return least;
}

double tidyCost(double cost) {
    constexpr int kFewDigits = 12, kAllDigits = 17;
    for (int digits = kFewDigits; digits < kAllDigits; ++digits) {
        std::array<char, 32> text;
        const auto end = std::to_chars(text.data(), text.data() + text.size(), cost,
                                       std::chars_format::scientific, digits - 1)
                             .ptr;
        double tidy = cost;
        std::from_chars(text.data(), end, tidy);
        if (!isCheaper(tidy, cost) && !isCheaper(cost, tidy)) return tidy;
    }
    return cost;
}

bool isConnected(const Problem& problem, const std::vector<Choice>& chosen) {
    return Connection(problem, chosen).parts() <= 1;
}

}  // namespace ispace
