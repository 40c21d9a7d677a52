// SPDX-License-Identifier: GPL-3.0-or-later
// The cheapest sensors that reach a value.
//
// Greedy search with doubled budgets finds a first solution. Levels of cost then bound the search
// from both sides: bisection by Lagrangian bounds raises the level that is proven to be too cheap,
// and searches with a lower budget lower the best cost. If all cells must be seen once, all sensors
// cost the same, and neither budget nor connection is asked, it is a set cover (cover_all.cc). At
// last, unless greedy, the value is maximised at the cost that was found. Invariant: no solution of
// level proven_ or below reaches the value.
#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>

#include "arrange/search/branch_and_bound.h"
#include "arrange/search/greedy_search.h"
#include "arrange/search/problem.h"
#include "arrange/search/relaxation.h"
#include "arrange/search/search.h"

namespace ispace {
namespace {

constexpr int kQuickRounds = 8;  // of a bound
constexpr int kFewStarts = 4;    // of swaps

/// \pre it is chosen
std::size_t positionOf(const Choice& choice, const CoverageState& state) {
    const auto& chosen = state.chosen();
    return static_cast<std::size_t>(std::find(chosen.begin(), chosen.end(), choice) -
                                    chosen.begin());
}

/// One search for a minimum-cost cover.
class MinimumCostSearch {
  public:
    MinimumCostSearch(const Problem& problem, std::uint64_t wanted, const SearchOptions& options,
                      Progress& progress)
        : problem_(problem), wanted_(wanted), options_(options), progress_(progress) {
        problem_.order.clear();
        partial_weights_ = partialWeights(problem_);
        bound_ = problem_.totalWeight();
    }
    MinimumCostCover run() {
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
    [[nodiscard]] Solution reduced(const Problem& cheaper, const Solution& solution) const;
    [[nodiscard]] MinimumCostCover unreached(const Solution& greedy);
    [[nodiscard]] MinimumCostCover cheapen(Solution best);
    [[nodiscard]] bool isSetCover() const;
    void lowerValueBound(const Solution& best, const LagrangeLimits& limits, Progress& progress);
    void raiseProven(const CostLevels& levels, const Solution& best, int rounds);
    void descend(const CostLevels& levels, Solution& best);
    void stepDown(const CostLevels& levels, Solution& best);
    bool take(const Solution& found, Solution& best) const;
    [[nodiscard]] Solution reach(const Problem& cheaper, const Solution& best, int starts);
    [[nodiscard]] Solution reachExactly(const Problem& cheaper, const Solution& best,
                                        bool& is_proven);
    [[nodiscard]] Bound boundOf(const Problem& cheaper, const Solution& best, int rounds) {
        return lagrangianBound(cheaper, best.chosen, {.cut = wanted_ - 1, .rounds = rounds},
                               progress_);
    }
    [[nodiscard]] Solution filled(const Solution& best);
    [[nodiscard]] MinimumCostCover reached(const Solution& best, double cost_bound);

    Problem problem_;
    std::uint64_t wanted_;
    const SearchOptions& options_;
    Progress& progress_;
    std::vector<std::uint32_t> partial_weights_;
    bool is_all_ = false;      // the greedy solution is optimal
    std::uint64_t bound_ = 0;  // of the value at the cost of the best solution
    std::size_t proven_ = 0;   // no solution of this cost level reaches the value
};

/// Returns the problem with this budget.
Problem MinimumCostSearch::within(double cost) const {
    Problem cheaper = problem_;
    if (cheaper.kinds.size() == 1) {
        SensorType& kind = cheaper.kinds[0];
        const auto most = static_cast<std::size_t>(std::max(kind.most, 0));
        kind.most = static_cast<int>(affordableCount(cost, 0, kind.cost, most));
    } else {
        cheaper.budget = std::min(cost, problem_.budget.value_or(cost));
    }
    return cheaper;
}

/// Adds twice as many sensors again and again, until the value is reached or no sensor gains.
Solution MinimumCostSearch::reachGreedily() {
    std::vector<Choice> everything;
    double cost = 0, dearest = 0;
    for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
        const SensorType& kind = problem_.kinds[k];
        for (std::size_t i = 0; i < kind.candidates->size(); ++i) everything.push_back({k, i});
        cost += kind.cost * kind.most;
        dearest = std::max(dearest, kind.cost);
    }
    const std::uint64_t most = valueOf(problem_, everything);
    if (problem_.budget) cost = std::min(cost, *problem_.budget);
    Solution solution;
    for (double limit = 4 * dearest;; limit *= 2) {
        const bool is_last = limit >= cost || progress_.stopped();
        solution = placeFeasibly(is_last ? problem_ : within(limit), progress_);
        is_all_ = solution.value == most;
        if (solution.value >= wanted_) return trimmed(solution, wanted_);
        if (is_last || is_all_) return solution;
    }
}

/// Returns the first sensors that reach this value, with redundant ones removed.
Solution MinimumCostSearch::trimmed(const Solution& solution, std::uint64_t value) const {
    CoverageState state(problem_, partial_weights_);
    const auto& chosen = solution.chosen;
    for (std::size_t i = 0; i < chosen.size() && state.value() < value; ++i) state.add(chosen[i]);
    if (!isFeasible(problem_, state.chosen())) {
        state.clear();
        for (const Choice& choice : chosen) state.add(choice);
    }
    // Expensive sensors go first, and among equals the last.
    std::vector<Choice> order(state.chosen().rbegin(), state.chosen().rend());
    std::stable_sort(order.begin(), order.end(), [this](const Choice& a, const Choice& b) {
        return problem_.kinds[a.kind].cost > problem_.kinds[b.kind].cost;
    });
    for (const Choice& choice : order) {
        // Connection depends on all of them.
        if (problem_.is_connected && progress_.stopped()) break;
        const std::size_t position = positionOf(choice, state);
        state.removeAt(position);
        const bool is_enough = state.value() >= value &&
                               (!problem_.is_connected || isFeasible(problem_, state.chosen()));
        if (!is_enough) state.insert(position, choice);
    }
    return {state.chosen(), state.value()};
}

/// Removes the sensors with the least loss per cost until the rest is cheap enough; returns an
/// empty solution if that is infeasible.
Solution MinimumCostSearch::reduced(const Problem& cheaper, const Solution& solution) const {
    CoverageState state(problem_, partial_weights_);
    for (const Choice& choice : solution.chosen) state.add(choice);
    using Loss = std::tuple<double, double, Choice>;  // of value, of parts; per cost
    const auto loss_of = [&](const Choice& choice) {
        const std::uint64_t value = state.value(), parts = state.partialValue();
        const std::size_t position = positionOf(choice, state);
        state.removeAt(position);
        const double cost = problem_.kinds[choice.kind].cost;
        const Loss loss(static_cast<double>(value - state.value()) / cost,
                        static_cast<double>(parts - state.partialValue()) / cost, choice);
        state.insert(position, choice);
        return loss;
    };
    // Lazily: with fewer others the loss of a sensor grows, or nearly always.
    std::priority_queue<Loss, std::vector<Loss>, std::greater<>> losses;
    for (const Choice& choice : solution.chosen) losses.push(loss_of(choice));
    const auto is_dear = [&] {
        if (cheaper.kinds.size() == 1)
            return state.chosen().size() > static_cast<std::size_t>(cheaper.kinds[0].most);
        return !isAffordable(cheaper, state.cost());
    };
    while (!losses.empty() && is_dear()) {
        const Choice choice = std::get<Choice>(losses.top());
        losses.pop();
        const Loss now = loss_of(choice);
        if (!losses.empty() && losses.top() < now)
            losses.push(now);
        else
            state.removeAt(positionOf(choice, state));
    }
    if (!isFeasible(cheaper, state.chosen())) return {{}, valueOf(problem_, {})};
    return {state.chosen(), state.value()};
}

/// Greedy search did not reach the value: either no choice does, or only the full search finds one.
MinimumCostCover MinimumCostSearch::unreached(const Solution& greedy) {
    MinimumCostCover cover;
    if (is_all_ || progress_.stopped()) {
        cover.result.best = greedy;
        cover.result.bound = is_all_ ? greedy.value : problem_.totalWeight();
        cover.result.is_complete = is_all_;
        cover.is_all = is_all_;
    } else {
        SearchOptions options = options_;
        options.swap.enough = wanted_;
        cover.result = search(problem_, options, progress_);
        bound_ = cover.result.bound;
        if (cover.result.best.value >= wanted_) return cheapen(trimmed(cover.result.best, wanted_));
    }
    cover.result.best = trimmed(cover.result.best, cover.result.best.value);
    cover.cost = normaliseCost(costOf(problem_, cover.result.best.chosen));
    // A positive value requires at least one sensor.
    cover.cost_bound = problem_.kinds.empty() ? 0 : problem_.kinds[0].cost;
    for (const SensorType& kind : problem_.kinds)
        cover.cost_bound = std::min(cover.cost_bound, kind.cost);
    return cover;
}

/// Finds a cheaper solution that reaches the value, or the best one that does not.
Solution MinimumCostSearch::reach(const Problem& cheaper, const Solution& best, int starts) {
    Solution solution{{}, 0};
    if (options_.optimizer != Optimizer::Greedy) solution = reduced(cheaper, best);
    // With one kind, greedy search would repeat itself with fewer sensors.
    if (cheaper.kinds.size() > 1 || cheaper.is_connected || solution.chosen.empty()) {
        const Solution greedy = placeFeasibly(cheaper, progress_);
        if (greedy.value > solution.value || solution.chosen.empty()) solution = greedy;
    }
    if (options_.optimizer == Optimizer::Greedy) return solution;
    SwapOptions swap = options_.swap;
    swap.starts = std::min(swap.starts, starts);
    swap.enough = wanted_;
    swap.share = &options_.share;
    return improveBySwaps(cheaper, solution, swap, progress_);
}

/// As reach(); Exact also runs branch and bound.
/// \param is_proven set if no cheaper solution reaches the value
Solution MinimumCostSearch::reachExactly(const Problem& cheaper, const Solution& best,
                                         bool& is_proven) {
    const bool is_greedy = options_.optimizer == Optimizer::Greedy;
    Bound bound;
    if (!is_greedy) {
        bound = boundOf(cheaper, best, LagrangeLimits().rounds);
        is_proven = bound.value < wanted_;
    }
    if (is_proven || progress_.stopped()) return {};
    Solution solution = reach(cheaper, best, options_.swap.starts);
    if (solution.value >= wanted_ || options_.optimizer != Optimizer::Exact) return solution;
    SearchResult known;
    known.best = {{}, wanted_ - 1};
    known.bound = bound.value;
    known = branchAndBound(cheaper, bound, known, 0, progress_, wanted_, options_.max_bytes,
                           options_.share);
    is_proven = known.bound < wanted_;
    return known.best.value >= wanted_ ? known.best : Solution();
}

/// Stores the found solution if it is better; returns true if so.
bool MinimumCostSearch::take(const Solution& found, Solution& best) const {
    if (found.value < wanted_) return false;
    Solution trim = trimmed(found, wanted_);
    if (!isCheaper(costOf(problem_, trim.chosen), costOf(problem_, best.chosen))) return false;
    best = std::move(trim);
    return true;
}

/// Computes bounds, by bisection, between the proven level and the best.
void MinimumCostSearch::raiseProven(const CostLevels& levels, const Solution& best, int rounds) {
    std::size_t open = levels.below(costOf(problem_, best.chosen)) + 1;
    while (proven_ + 1 < open && !progress_.stopped()) {
        const std::size_t middle = (proven_ + open) / 2;
        if (boundOf(within(levels.at(middle)), best, rounds).value < wanted_)
            proven_ = middle;
        else
            open = middle;
    }
}

/// Searches with few starts: in longer and longer steps down from the best, and by bisection once a
/// step fails.
void MinimumCostSearch::descend(const CostLevels& levels, Solution& best) {
    std::size_t tried = proven_;
    std::size_t step = 0;  // 0: bisection
    for (bool is_first = true; !progress_.stopped(); is_first = false) {
        const std::size_t open = levels.below(costOf(problem_, best.chosen));
        if (open <= tried) return;
        if (is_first) step = 1 + open / 64;
        const std::size_t middle = (tried + open + 1) / 2;
        const std::size_t level =
            step > 0 && step <= open ? std::max(middle, open + 1 - step) : middle;
        if (take(reach(within(levels.at(level)), best, kFewStarts), best)) {
            step *= 2;
        } else {
            step = 0;
            tried = level;
        }
    }
}

/// Searches for the next cheaper solution, again and again, with the optimizer of the options.
void MinimumCostSearch::stepDown(const CostLevels& levels, Solution& best) {
    while (!progress_.stopped()) {
        const std::size_t open = levels.below(costOf(problem_, best.chosen));
        if (open <= proven_) return;
        bool is_proven = false;
        const Solution found = reachExactly(within(levels.at(open)), best, is_proven);
        if (is_proven) proven_ = open;
        if (!take(found, best)) return;
    }
}

/// Returns true if the fewest sensors have to see every cell.
bool MinimumCostSearch::isSetCover() const {
    return problem_.required == 1 && !problem_.is_connected && !problem_.budget &&
           wanted_ == problem_.totalWeight() &&
           std::all_of(
               problem_.kinds.begin(), problem_.kinds.end(),
               [this](const SensorType& kind) { return kind.cost == problem_.kinds.front().cost; });
}

/// Order by use of time: quick bounds, a descent with few starts, then the full search of each
/// level. A stop in between leaves a cover and bounds that hold.
MinimumCostCover MinimumCostSearch::cheapen(Solution best) {
    const double most = costOf(problem_, best.chosen);
    const CostLevels levels(problem_.kinds, most);
    // Computes quick bounds first, in case time runs out.
    lowerValueBound(best, {.cut = best.value, .gap = 0.01, .rounds = 2}, progress_);
    raiseProven(levels, best, kQuickRounds);
    if (options_.optimizer != Optimizer::Greedy) {
        descend(levels, best);
        lowerValueBound(best, {.cut = best.value, .gap = 0.001}, progress_);
    }
    if (options_.optimizer != Optimizer::Greedy && isSetCover() && !progress_.stopped()) {
        const WholeCover cover =
            coverAllCells(problem_, best.chosen, options_.optimizer == Optimizer::Exact, progress_);
        best = {cover.chosen, wanted_};
        const double cost = problem_.kinds.front().cost;
        proven_ = std::max(proven_, levels.below(static_cast<double>(cover.bound) * cost));
    }
    stepDown(levels, best);
    if (options_.optimizer != Optimizer::Greedy) raiseProven(levels, best, LagrangeLimits().rounds);
    return reached(best, levels.above(proven_));
}

/// Lowers the bound of the value at the best solution's cost.
void MinimumCostSearch::lowerValueBound(const Solution& best, const LagrangeLimits& limits,
                                        Progress& progress) {
    const double cost = costOf(problem_, best.chosen);
    const Bound bound = lagrangianBound(within(cost), best.chosen, limits, progress);
    bound_ = std::min(bound_, bound.value);
}

/// Maximises the value at the cost that is known to suffice.
Solution MinimumCostSearch::filled(const Solution& best) {
    SearchOptions options = options_;
    options.optimizer = Optimizer::Swap;  // the tree is reserved for the number of sensors
    const SearchResult found = search(within(costOf(problem_, best.chosen)), options, progress_);
    bound_ = std::min(bound_, found.bound);
    return found.best.value > best.value ? trimmed(found.best, found.best.value) : best;
}

/// Unless greedy or stopped, also uses what the cost leaves: of the covers of this cost, it
/// searches for the one of the most value.
MinimumCostCover MinimumCostSearch::reached(const Solution& best, double cost_bound) {
    MinimumCostCover cover;
    cover.is_reached = true;
    cover.result.best = best;
    if (progress_.stopped()) {
        SilentProgress silent;  // a bound is always required
        lowerValueBound(best, {.cut = best.value, .gap = 0.01, .rounds = 2}, silent);
    } else if (options_.optimizer == Optimizer::Greedy) {
        lowerValueBound(best, {.cut = best.value, .gap = 0.01, .rounds = kQuickRounds}, progress_);
    } else {
        cover.result.best = filled(best);
    }
    cover.cost = normaliseCost(costOf(problem_, cover.result.best.chosen));
    cover.cost_bound = isCheaper(cost_bound, cover.cost) ? normaliseCost(cost_bound) : cover.cost;
    cover.result.bound = bound_;
    cover.result.is_complete = !progress_.stopped();
    return cover;
}

}  // namespace

MinimumCostCover minimumCostCover(const Problem& problem, std::uint64_t wanted,
                                  const SearchOptions& options, Progress& progress) {
    return MinimumCostSearch(problem, wanted, options, progress).run();
}

}  // namespace ispace
