// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "place/exact.h"
#include "place/lagrange.h"
#include "place/search.h"

namespace ispace {
namespace {

constexpr double kCostSlack = 1e-9;  // costs nearer than this fraction are the same
constexpr std::size_t kMostLevels = 4'000;

bool isLess(double cost, double than) { return cost < than * (1 - kCostSlack); }

/// What sets of sensors can cost, ascending, from 0 up to a cost, each once; or, if there are very
/// many, even steps.
class CostLevels {
  public:
    CostLevels(const Problem& problem, double most) {
        levels_ = {0};
        for (const Kind& kind : problem.kinds) {
            std::vector<double> sums;
            for (const double level : levels_)
                for (int n = 0; n <= kind.most && !isLess(most, level + n * kind.cost); ++n) {
                    sums.push_back(level + n * kind.cost);
                    if (sums.size() > 100 * kMostLevels) break;
                }
            std::sort(sums.begin(), sums.end());
            const auto same = [](double a, double b) { return !isLess(a, b); };
            sums.erase(std::unique(sums.begin(), sums.end(), same), sums.end());
            levels_ = std::move(sums);
            if (levels_.size() > kMostLevels) {
                setEven(most);
                return;
            }
        }
    }
    [[nodiscard]] double at(std::size_t i) const { return levels_[i]; }
    /// The highest level that costs less. \pre cost is above 0
    [[nodiscard]] std::size_t below(double cost) const {
        std::size_t i = 0;
        while (i + 1 < levels_.size() && isLess(levels_[i + 1], cost)) ++i;
        return i;
    }
    /// What costs more than level i costs at least this. \param most what was found
    [[nodiscard]] double above(std::size_t i, double most) const {
        if (is_even_) return levels_[i];
        return i + 1 < levels_.size() ? std::min(levels_[i + 1], most) : most;
    }

  private:
    void setEven(double most) {
        is_even_ = true;
        levels_.resize(kMostLevels + 1);
        for (std::size_t i = 0; i < levels_.size(); ++i)
            levels_[i] = most * static_cast<double>(i) / static_cast<double>(kMostLevels);
    }

    std::vector<double> levels_;
    bool is_even_ = false;
};

/// Looks for the cheapest that is worth something.
class FewestSearch {
  public:
    FewestSearch(const Problem& problem, std::uint64_t wanted, const SearchOptions& options,
                 Progress& progress)
        : problem_(problem), wanted_(wanted), options_(options), progress_(progress) {
        problem_.order.clear();
    }
    Fewest run() {
        const Solution nothing{{}, valueOf(problem_, {})};
        if (nothing.value >= wanted_) return reached(nothing, 0);
        const Solution first = reachGreedily();
        if (first.value < wanted_) return unreached(first);
        return cheapen(first);
    }

  private:
    [[nodiscard]] Problem within(double cost) const;
    [[nodiscard]] Solution reachGreedily();
    [[nodiscard]] Solution trimmed(const Solution& solution, std::uint64_t value) const;
    [[nodiscard]] Fewest unreached(const Solution& greedy);
    [[nodiscard]] Fewest cheapen(Solution best);
    [[nodiscard]] Solution reach(const Problem& cheaper, const Solution& best, const Bound& bound,
                                 bool& is_proven);
    [[nodiscard]] Bound boundOf(const Problem& cheaper, const Solution& best) {
        return boundWithin(cheaper, best.chosen, {.cut = wanted_ - 1, .has_counts = false},
                           progress_);
    }
    [[nodiscard]] Fewest reached(const Solution& best, double least_cost);

    Problem problem_;
    std::uint64_t wanted_;
    const SearchOptions& options_;
    Progress& progress_;
    bool is_all_ = false;  // there is nothing worth more than what was placed greedily
};

/// The problem with no more to spend.
Problem FewestSearch::within(double cost) const {
    Problem cheaper = problem_;
    if (cheaper.kinds.size() == 1) {
        const double count = std::floor(cost / cheaper.kinds[0].cost * (1 + kCostSlack));
        cheaper.kinds[0].most = static_cast<int>(std::min<double>(cheaper.kinds[0].most, count));
    } else {
        cheaper.budget = std::min(cost, problem_.budget.value_or(cost));
    }
    return cheaper;
}

/// Places twice as many again and again, until it is enough or nothing more can be had.
Solution FewestSearch::reachGreedily() {
    std::vector<Choice> everything;
    double cost = 0, dearest = 0;
    for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
        const Kind& kind = problem_.kinds[k];
        for (std::size_t i = 0; i < kind.candidates->size(); ++i) everything.push_back({k, i});
        cost += kind.cost * kind.most;
        dearest = std::max(dearest, kind.cost);
    }
    const std::uint64_t most = valueOf(problem_, everything);
    if (problem_.budget) cost = std::min(cost, *problem_.budget);
    Solution solution;
    for (double limit = 4 * dearest;; limit *= 2) {
        const bool is_last = limit >= cost || progress_.stopped();
        solution = placeGreedily(is_last ? problem_ : within(limit), progress_);
        if (!isFeasible(problem_, solution.chosen)) solution = {{}, valueOf(problem_, {})};
        is_all_ = solution.value == most;
        if (solution.value >= wanted_) return trimmed(solution, wanted_);
        if (is_last || is_all_) return solution;
    }
}

/// The first of the sensors that are worth so much, without those that are not needed for it.
Solution FewestSearch::trimmed(const Solution& solution, std::uint64_t value) const {
    const auto& chosen = solution.chosen;
    const auto firstOf = [&chosen](std::size_t n) {
        return std::vector<Choice>(chosen.begin(), chosen.begin() + static_cast<long>(n));
    };
    const auto isEnough = [&](const std::vector<Choice>& some) {
        return valueOf(problem_, some) >= value && isFeasible(problem_, some);
    };
    std::size_t low = 0, high = chosen.size();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (valueOf(problem_, firstOf(middle)) >= value)
            high = middle;
        else
            low = middle + 1;
    }
    std::vector<Choice> kept = firstOf(high);
    if (!isFeasible(problem_, kept)) kept = chosen;
    // Dear ones go first, and among equals the last.
    std::vector<Choice> order(kept.rbegin(), kept.rend());
    std::stable_sort(order.begin(), order.end(), [this](const Choice& a, const Choice& b) {
        return problem_.kinds[a.kind].cost > problem_.kinds[b.kind].cost;
    });
    for (const Choice& choice : order) {
        std::vector<Choice> without = kept;
        without.erase(std::find(without.begin(), without.end(), choice));
        if (isEnough(without)) kept = std::move(without);
    }
    return {kept, valueOf(problem_, kept)};
}

Fewest FewestSearch::unreached(const Solution& greedy) {
    Fewest fewest;
    if (is_all_ || progress_.stopped()) {
        fewest.result.best = greedy;
        fewest.result.bound = is_all_ ? greedy.value : problem_.totalWeight();
        fewest.result.is_complete = is_all_;
    } else {
        fewest.result = search(problem_, options_, progress_);
        if (fewest.result.best.value >= wanted_) return cheapen(fewest.result.best);
    }
    fewest.result.best = trimmed(fewest.result.best, fewest.result.best.value);
    fewest.cost = costOf(problem_, fewest.result.best.chosen);
    // If it can be had at all, it costs more than nothing.
    fewest.least_cost = problem_.kinds.empty() ? 0 : problem_.kinds[0].cost;
    for (const Kind& kind : problem_.kinds)
        fewest.least_cost = std::min(fewest.least_cost, kind.cost);
    return fewest;
}

/// Something cheaper that is worth enough, or choices that are worth less.
Solution FewestSearch::reach(const Problem& cheaper, const Solution& best, const Bound& bound,
                             bool& is_proven) {
    is_proven = bound.value < wanted_;
    if (is_proven || progress_.stopped()) return {};
    Solution solution = placeGreedily(cheaper, progress_);
    if (!isFeasible(cheaper, solution.chosen)) solution = {{}, valueOf(cheaper, {})};
    if (solution.value >= wanted_ || options_.optimizer == Optimizer::Greedy) return solution;
    solution = improveBySwaps(cheaper, solution, options_.swap, progress_);
    if (solution.value >= wanted_ || options_.optimizer != Optimizer::Exact) return solution;
    SearchResult known;
    known.best = {{}, wanted_ - 1};
    known.bound = bound.value;
    known = branchAndBound(cheaper, bound, known, 0, progress_, wanted_);
    is_proven = known.bound < wanted_;
    return known.best.value >= wanted_ ? known.best : best;
}

Fewest FewestSearch::cheapen(Solution best) {
    const CostLevels levels(problem_, costOf(problem_, best.chosen));
    std::size_t proven = 0;  // of this level nothing is worth enough
    std::size_t open = 0;    // nor has anything been found of this one
    while (true) {
        open = levels.below(costOf(problem_, best.chosen));
        if (open <= proven || progress_.stopped()) break;
        const Problem cheaper = within(levels.at(open));
        bool is_proven = false;
        const Solution found = reach(cheaper, best, boundOf(cheaper, best), is_proven);
        if (is_proven) proven = open;
        const Solution trim = found.value >= wanted_ ? trimmed(found, wanted_) : best;
        if (!isLess(costOf(problem_, trim.chosen), costOf(problem_, best.chosen))) break;
        best = trim;
    }
    while (proven + 1 < open && !progress_.stopped()) {
        const std::size_t middle = (proven + open) / 2;
        if (boundOf(within(levels.at(middle)), best).value < wanted_)
            proven = middle;
        else
            open = middle;
    }
    return reached(best, levels.above(proven, costOf(problem_, best.chosen)));
}

Fewest FewestSearch::reached(const Solution& best, double least_cost) {
    Fewest fewest;
    fewest.is_reached = true;
    fewest.cost = costOf(problem_, best.chosen);
    fewest.least_cost = std::min(least_cost, fewest.cost);
    fewest.result.best = best;
    fewest.result.bound = problem_.totalWeight();
    fewest.result.is_complete = !progress_.stopped();
    if (progress_.stopped()) return fewest;
    const Bound bound =
        boundWithin(within(fewest.cost), best.chosen, {.cut = best.value, .gap = 0.001}, progress_);
    fewest.result.bound = bound.value;
    fewest.result.bound_by_count = bound.by_count;
    return fewest;
}

}  // namespace

Fewest placeFewest(const Problem& problem, std::uint64_t wanted, const SearchOptions& options,
                   Progress& progress) {
    return FewestSearch(problem, wanted, options, progress).run();
}

}  // namespace ispace
