// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/search.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "solve/branch_and_bound.h"
#include "solve/lagrange.h"

namespace ispace {

namespace {

// A bound that is to be quick, and one that is to be good.
constexpr LagrangeLimits kQuick = {.gap = 0.01, .rounds = 8};
constexpr double kSmallGap = 0.001;

LagrangeLimits limitsOf(const SearchOptions& options) {
    LagrangeLimits limits;
    switch (options.optimizer) {
        case Optimizer::Greedy:
            limits = kQuick;
            limits.gap = std::max(limits.gap, options.gap);
            break;
        case Optimizer::Swap:
            limits.gap = std::max(kSmallGap, options.gap);
            break;
        case Optimizer::Exact:
            limits.gap = options.gap;
            break;
    }
    return limits;
}

/// What need not be made better.
std::uint64_t enoughOf(const Problem& problem, std::uint64_t bound, double gap) {
    // Swaps also look for cheaper solutions of the same value.
    if (problem.budget && gap <= 0) return std::numeric_limits<std::uint64_t>::max();
    return bound -
           static_cast<std::uint64_t>(std::clamp(gap, 0.0, 1.0) * static_cast<double>(bound));
}

}  // namespace

std::string_view nameOf(Optimizer optimizer) {
    switch (optimizer) {
        case Optimizer::Greedy:
            return "greedy";
        case Optimizer::Swap:
            return "swap";
        case Optimizer::Exact:
            break;
    }
    return "exact";
}

Solution placeFeasibly(const Problem& problem, Progress& progress) {
    Solution solution = placeGreedily(problem, progress);
    if (!isFeasible(problem, solution.chosen)) solution = {{}, valueOf(problem, {})};
    return solution;
}

SearchResult search(const Problem& problem, const SearchOptions& options, Progress& progress) {
    SearchResult result;
    result.bound = problem.totalWeight();
    result.best = placeFeasibly(problem, progress);
    noteProgress(problem, result, progress);
    if (options.optimizer != Optimizer::Greedy && !progress.stopped()) {
        // Swaps may take long: if there is no time for more, this is the bound.
        LagrangeLimits quick = kQuick;
        quick.cut = result.best.value;
        quick.gap = std::min(quick.gap, limitsOf(options).gap);
        result.bound = lagrangianBound(problem, result.best.chosen, quick, progress).value;
        noteProgress(problem, result, progress);
        SwapOptions swap = options.swap;
        swap.enough = std::min(swap.enough, enoughOf(problem, result.bound, options.gap));
        result.best = improveBySwaps(problem, result.best, swap, progress);
    }
    if (!progress.stopped()) {
        LagrangeLimits limits = limitsOf(options);
        limits.cut = result.best.value;
        const Bound bound = lagrangianBound(problem, result.best.chosen, limits, progress);
        result.bound = std::min(result.bound, bound.value);
        noteProgress(problem, result, progress);
        if (options.optimizer == Optimizer::Exact && !progress.stopped() &&
            result.best.value < result.bound)
            result = branchAndBound(problem, bound, std::move(result), options.gap, progress,
                                    std::numeric_limits<std::uint64_t>::max(), options.max_bytes);
    }
    if (result.bound == problem.totalWeight() && progress.stopped()) {
        SilentProgress silent;  // there shall be some bound
        const LagrangeLimits soon = {.cut = result.best.value, .gap = kQuick.gap, .rounds = 2};
        result.bound = lagrangianBound(problem, result.best.chosen, soon, silent).value;
    }
    if (progress.stopped() && result.best.value < result.bound) result.is_complete = false;
    return result;
}

void noteProgress(const Problem& problem, std::uint64_t value, std::uint64_t bound,
                  Progress& progress) {
    const double total = static_cast<double>(std::max<std::uint64_t>(problem.totalWeight(), 1));
    char text[80];
    const int length = std::snprintf(text, sizeof text, "best %.1f %%, at most %.1f %%",
                                     100 * static_cast<double>(value) / total,
                                     100 * static_cast<double>(bound) / total);
    progress.note({text, static_cast<std::size_t>(length)});
}

}  // namespace ispace
