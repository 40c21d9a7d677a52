// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "arrange/search/greedy_search.h"
#include "arrange/search/search.h"
#include "support/test_problems.h"

namespace ispace {
namespace greedy_search_test {

bool holds(const std::vector<Choice>& chosen, const Choice& choice) {
    return std::find(chosen.begin(), chosen.end(), choice) != chosen.end();
}

/// Computes the multiplicity of cells from standing sensors and from different choices.
std::vector<int> loadsOf(const Problem& problem, const std::vector<Choice>& chosen) {
    std::vector<int> loads(problem.achieved.begin(), problem.achieved.end());
    loads.resize(problem.cells(), 0);
    for (const Choice& choice : chosen) {
        const SensorType& kind = problem.kinds[choice.kind];
        kind.candidates->cellsOf(choice.candidate).forEach([&](std::size_t cell) {
            loads[cell] += kind.multiplicity;
        });
    }
    return loads;
}

/// The gain of greedy placement: weights times 840, each by the number of sensors of its kind that
/// the cell lacks; then the parts of the demand that are met.
using Gain = std::pair<std::uint64_t, std::uint64_t>;

Gain gainOf(const Problem& problem, const std::vector<int>& loads, const Choice& choice,
            int to_come) {
    const int multiplicity = problem.kinds[choice.kind].multiplicity;
    bool takes_steps = false;
    for (const SensorType& kind : problem.kinds)
        takes_steps |= kind.multiplicity < problem.required;
    Gain gain;
    problem.kinds[choice.kind].candidates->cellsOf(choice.candidate).forEach([&](std::size_t cell) {
        const int lack = problem.required - loads[cell];
        if (lack <= 0) return;
        const std::uint64_t weight = problem.weights[cell];
        const auto sensors = static_cast<std::uint64_t>((lack + multiplicity - 1) / multiplicity);
        if (lack <= multiplicity + to_come) gain.first += weight * 840 / sensors;
        if (takes_steps)
            gain.second += weight * static_cast<std::uint64_t>(std::min(multiplicity, lack));
    });
    return gain;
}

/// Looks at every candidate every time. For problems without budget.
std::vector<Choice> naiveGreedy(const Problem& problem) {
    std::vector<Choice> chosen;
    std::vector<int> counts(problem.kinds.size(), 0);
    int sensors = 0, multiplicities = 0;
    for (const SensorType& kind : problem.kinds) {
        sensors += kind.most;
        multiplicities += kind.most * std::min(kind.multiplicity, problem.required);
    }
    for (int i = 0; i < sensors; ++i) {
        const std::vector<int> loads = loadsOf(problem, chosen);
        std::optional<Choice> best;
        Gain most;
        for (std::size_t kind = 0; kind < problem.kinds.size(); ++kind) {
            if (!problem.order.empty() && problem.order[static_cast<std::size_t>(i)] != kind)
                continue;
            if (counts[kind] == problem.kinds[kind].most) continue;
            const int to_come =
                multiplicities - std::min(problem.kinds[kind].multiplicity, problem.required);
            for (std::size_t c = 0; c < problem.kinds[kind].candidates->size(); ++c) {
                auto more = chosen;
                more.push_back({kind, c});
                if (holds(chosen, {kind, c})) continue;
                if (problem.is_connected && !isConnected(problem, more)) continue;
                const Gain gain = gainOf(problem, loads, {kind, c}, to_come);
                if (best && gain <= most) continue;
                best = Choice{kind, c};
                most = gain;
            }
        }
        if (!best) break;
        chosen.push_back(*best);
        ++counts[best->kind];
        multiplicities -= std::min(problem.kinds[best->kind].multiplicity, problem.required);
    }
    return chosen;
}

void expectNaive(const RandomProblemOptions& options, std::uint64_t seeds) {
    SilentProgress progress;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        const Solution solution = placeGreedily(made.problem, progress);
        EXPECT_EQ(solution.chosen, naiveGreedy(made.problem)) << seed;
        EXPECT_EQ(solution.value, valueOf(made.problem, solution.chosen)) << seed;
        EXPECT_TRUE(isFeasible(made.problem, solution.chosen)) << seed;
    }
}

TEST(GreedySearch, IsNaiveGreedy) {
    RandomProblemOptions options;
    options.sites = 12;
    options.most = 5;
    expectNaive(options, 60);
    options.max_weight = 20;
    options.kinds = 2;
    expectNaive(options, 40);
}

TEST(GreedySearch, IsNaiveGreedyInOrder) {
    RandomProblemOptions options;
    options.kinds = 3;
    options.most = 2;
    options.has_order = true;
    expectNaive(options, 60);
}

TEST(GreedySearch, IsNaiveGreedyWithDemandAndWhatStands) {
    RandomProblemOptions options;
    options.kinds = 2;
    options.required = 4;
    options.multiplicities = {1, 4};
    options.max_achieved = 3;
    options.max_weight = 5;
    expectNaive(options, 60);
    options.required = 8;
    options.most = 4;
    options.has_order = true;
    expectNaive(options, 40);
}

TEST(GreedySearch, IsNaiveGreedyWhereItTakesSeveral) {
    RandomProblemOptions options;
    options.columns = 24;
    options.rows = 20;
    options.sites = 20;
    options.most = 8;
    for (options.required = 2; options.required <= 4; ++options.required) expectNaive(options, 30);
    options.columns = 16;
    options.required = 2;
    options.is_connected = true;
    expectNaive(options, 20);
}

TEST(GreedySearch, MeetsDemandsRatherThanPartsOfThem) {
    const std::size_t cells = 12;
    const auto set_of = [](std::size_t first, std::size_t end) {
        CellSet set(cells);
        for (std::size_t cell = first; cell < end; ++cell) set.set(cell);
        return set;
    };
    CandidateSet candidates(cells), others(cells);
    candidates.addSite(set_of(0, 6));
    candidates.addSite(set_of(6, 12));
    candidates.addSite(set_of(1, 4));
    others.addSite(set_of(0, 12));
    Problem problem;
    problem.weights.assign(cells, 1);
    problem.required = 2;
    problem.kinds = {{&candidates, 2}};
    SilentProgress progress;
    const std::vector<Choice> same_place{{0, 0}, {0, 2}};
    EXPECT_EQ(placeGreedily(problem, progress).chosen, same_place);
    EXPECT_EQ(placeGreedily(problem, progress).value, 3U);
    // A budget leaves at most two, too, and rejects the more expensive ones.
    problem.kinds = {{&candidates, 3, 1, 1}, {&others, 3, 2, 1}};
    problem.budget = 2;
    EXPECT_EQ(placeGreedily(problem, progress).chosen, same_place);
    // Later sensors may cost more and meet more: a first step towards that has a value.
    CandidateSet few(cells);
    few.addSite(set_of(0, 4));
    problem.required = 5;
    problem.kinds = {{&others, 3, 1, 1}, {&few, 3, 2, 4}};
    problem.budget = 3;
    EXPECT_EQ(placeGreedily(problem, progress).chosen, (std::vector<Choice>{{0, 0}, {1, 0}}));
    problem.required = 2;
    // One sensor completes no cell: it goes to the most half-met cells.
    problem.budget.reset();
    problem.kinds = {{&candidates, 1}};
    EXPECT_EQ(placeGreedily(problem, progress).chosen, (std::vector<Choice>{{0, 0}}));
    // A cell that one sensor completes counts more than a quarter of more cells.
    problem.required = 4;
    problem.kinds = {{&others, 1, 1, 1}, {&candidates, 1, 1, 4}};
    EXPECT_EQ(placeGreedily(problem, progress).chosen.front(), (Choice{1, 0}));
    problem.achieved = {0, 0, 0, 0, 0, 0, 3, 3, 3, 3, 3, 3};
    problem.kinds = {{&candidates, 1, 1, 1}};
    EXPECT_EQ(placeGreedily(problem, progress).chosen, (std::vector<Choice>{{0, 1}}));
}

TEST(GreedySearch, IsWorthMoreThanPartsOfDemands) {
    SilentProgress progress;
    RandomProblemOptions options;
    options.sites = 40;
    options.columns = 30;
    options.rows = 25;
    options.max_range = 8;
    for (options.required = 2; options.required <= 4; ++options.required) {
        options.most = 3 * options.required;
        std::uint64_t value = 0, value_of_parts = 0;
        for (std::uint64_t seed = 0; seed < 10; ++seed) {
            const RandomProblem made = randomProblem(seed, options);
            const SearchBasis basis(made.problem);
            CoverageState parts = basis.emptyState();
            placeRest(basis, false, parts, progress);
            value_of_parts += parts.value();
            value += placeGreedily(made.problem, progress).value;
        }
        EXPECT_GT(value * 10, value_of_parts * 12) << options.required;
    }
}

TEST(GreedySearch, IsNaiveGreedyConnected) {
    RandomProblemOptions options;
    options.columns = 20;
    options.sites = 10;
    options.max_range = 4;
    options.most = 4;
    options.is_connected = true;
    expectNaive(options, 40);
    options.has_standing = true;
    expectNaive(options, 40);
}

TEST(GreedySearch, ReachesItsShareOfTheOptimum) {
    SilentProgress progress;
    const double multiplicity = 1 - std::exp(-1.0);
    RandomProblemOptions options;
    options.max_weight = 4;
    options.columns = 16;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        const auto best = static_cast<double>(bestByBruteForce(made.problem).value);
        const auto value = static_cast<double>(placeGreedily(made.problem, progress).value);
        EXPECT_GE(value, multiplicity * best) << seed;
        EXPECT_LE(value, best) << seed;
    }
}

TEST(GreedySearch, KeepsTheBudgetAndBuysTheBetterWay) {
    SilentProgress progress;
    RandomProblemOptions options;
    options.kinds = 3;
    options.sites = 3;
    options.most = 2;
    options.has_costs = true;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        const Solution solution = placeGreedily(made.problem, progress);
        EXPECT_TRUE(isFeasible(made.problem, solution.chosen)) << seed;
        // The cheapest that is left over does not fit any more.
        const double left = *made.problem.budget - costOf(made.problem, solution.chosen);
        for (std::size_t kind = 0; kind < 3; ++kind) {
            const auto is_of = [kind](const Choice& choice) { return choice.kind == kind; };
            const auto count = std::count_if(solution.chosen.begin(), solution.chosen.end(), is_of);
            EXPECT_TRUE(count == 2 || left < made.problem.kinds[kind].cost) << seed;
        }
    }
}

/// Three candidates of one cell each, one of all four cells, of two kinds.
TEST(GreedySearch, TakesGainPerCostOrGainWhateverIsMore) {
    const std::size_t cells = 6;
    CandidateSet cheap(cells), dear(cells);
    for (std::size_t cell = 0; cell < 3; ++cell) {
        CellSet one(cells);
        one.set(cell);
        cheap.addSite(one);
    }
    CellSet four(cells);
    for (std::size_t cell = 2; cell < 6; ++cell) four.set(cell);
    dear.addSite(four);
    Problem problem;
    problem.weights.assign(cells, 1);
    problem.kinds = {{&cheap, 3, 1, 1}, {&dear, 1, 4.5, 1}};
    problem.budget = 5;
    SilentProgress progress;
    EXPECT_EQ(placeGreedily(problem, progress).chosen, (std::vector<Choice>{{1, 0}}));
    problem.kinds[1].cost = 5;
    problem.budget = 3;
    EXPECT_EQ(placeGreedily(problem, progress).value, 3U);
    problem.budget = 0;
    EXPECT_TRUE(placeGreedily(problem, progress).chosen.empty());
}

TEST(GreedySearch, PlacesAllAlsoWhereNothingIsGained) {
    CandidateSet candidates(2), none(2);
    CellSet first(2);
    first.set(0);
    candidates.addSite(CellSet(2));
    candidates.addSite(first);
    Problem problem;
    problem.weights = {1, 1};
    problem.kinds = {{&candidates, 4}, {&none, 2}};
    SilentProgress progress;
    const Solution solution = placeGreedily(problem, progress);
    EXPECT_EQ(solution.chosen, (std::vector<Choice>{{0, 1}, {0, 0}, {0, 0}, {0, 0}}));
    EXPECT_EQ(solution.value, 1U);
    problem.kinds.clear();
    EXPECT_TRUE(placeGreedily(problem, progress).chosen.empty());
}

TEST(GreedySearch, LeavesOutWhatCannotBeConnected) {
    CandidateSet candidates(4), apart(4);
    CellSet low(4), high(4);
    low.set(0);
    low.set(1);
    high.set(2);
    high.set(3);
    candidates.addSite(low);
    apart.addSite(high);
    Problem problem;
    problem.weights = {1, 1, 1, 1};
    problem.kinds = {{&candidates, 1}, {&apart, 1}};
    problem.is_connected = true;
    SilentProgress progress;
    EXPECT_EQ(placeGreedily(problem, progress).chosen, (std::vector<Choice>{{0, 0}}));
    problem.order = {1, 0};
    EXPECT_EQ(placeGreedily(problem, progress).chosen, (std::vector<Choice>{{1, 0}}));
}

TEST(GreedySearch, StoppedItStillPlacesAll) {
    RandomProblemOptions options;
    options.most = 5;
    options.sites = 9;
    StopWhen progress(always);
    const RandomProblem made = randomProblem(1, options);
    const Solution solution = placeGreedily(made.problem, progress);
    EXPECT_EQ(solution.chosen.size(), 5U);
    EXPECT_EQ(solution.value, valueOf(made.problem, solution.chosen));
}

TEST(GreedySearch, StoppedItPlacesThirtyTwoWithCare) {
    RandomProblemOptions options;
    options.most = 50;
    options.sites = 80;
    options.columns = 60;
    options.rows = 50;
    StopWhen stopped(always);
    SilentProgress progress;
    for (options.required = 1; options.required <= 2; ++options.required) {
        const RandomProblem made = randomProblem(2, options);
        const std::vector<Choice> careful = placeGreedily(made.problem, progress).chosen;
        const std::vector<Choice> hasty = placeGreedily(made.problem, stopped).chosen;
        ASSERT_EQ(hasty.size(), 50U);
        EXPECT_TRUE(std::equal(careful.begin(), careful.begin() + 32, hasty.begin()));
        EXPECT_NE(hasty, careful);
    }
    // Both ways to buy.
    options.required = 1;
    options.kinds = 3;
    options.most = 4;
    options.has_costs = true;
    const RandomProblem made = randomProblem(3, options);
    EXPECT_EQ(placeGreedily(made.problem, stopped).chosen,
              placeGreedily(made.problem, progress).chosen);
}

TEST(GreedySearch, HeaviestWeightsDoNotOverflow) {
    CandidateSet candidates(2);
    for (std::size_t cell = 0; cell < 2; ++cell) {
        CellSet one(2);
        one.set(cell);
        candidates.addSite(one);
    }
    Problem problem;
    problem.weights = {1, std::numeric_limits<std::uint32_t>::max() - 2};
    problem.kinds = {{&candidates, 1, 1, 7}};
    problem.required = 7;
    SilentProgress progress;
    const Solution solution = placeGreedily(problem, progress);
    EXPECT_EQ(solution.chosen, (std::vector<Choice>{{0, 1}}));
    EXPECT_EQ(solution.value, problem.weights[1]);
}

}  // namespace greedy_search_test
}  // namespace ispace
