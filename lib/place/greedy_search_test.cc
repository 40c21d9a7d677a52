// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "place/search.h"
#include "place/test_problems.h"

namespace ispace {
namespace {

/// Shares met, at most the demand, of all cells: what greedy placement makes more.
std::uint64_t partsOf(const Problem& problem, const std::vector<Choice>& chosen) {
    Problem step = problem;
    std::uint64_t sum = 0;
    for (step.demand = 1; step.demand <= problem.demand; ++step.demand)
        sum += valueOf(step, chosen);
    return sum;
}

bool holds(const std::vector<Choice>& chosen, const Choice& choice) {
    return std::find(chosen.begin(), chosen.end(), choice) != chosen.end();
}

/// Looks at every candidate every time. For problems without budget.
std::vector<Choice> naiveGreedy(const Problem& problem) {
    std::vector<Choice> chosen;
    std::vector<int> counts(problem.kinds.size(), 0);
    std::size_t sensors = 0;
    for (const Kind& kind : problem.kinds) sensors += static_cast<std::size_t>(kind.most);
    for (std::size_t i = 0; i < sensors; ++i) {
        std::optional<Choice> best;
        std::uint64_t most = 0;
        for (std::size_t kind = 0; kind < problem.kinds.size(); ++kind) {
            if (!problem.order.empty() && problem.order[i] != kind) continue;
            if (counts[kind] == problem.kinds[kind].most) continue;
            for (std::size_t c = 0; c < problem.kinds[kind].candidates->size(); ++c) {
                auto more = chosen;
                more.push_back({kind, c});
                if (holds(chosen, {kind, c})) continue;
                if (problem.is_connected && !isConnected(problem, more)) continue;
                const std::uint64_t parts = partsOf(problem, more);
                if (best && parts <= most) continue;
                best = Choice{kind, c};
                most = parts;
            }
        }
        if (!best) break;
        chosen.push_back(*best);
        ++counts[best->kind];
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
    options.demand = 4;
    options.shares = {1, 4};
    options.max_met = 3;
    options.max_weight = 5;
    expectNaive(options, 60);
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
    const double share = 1 - std::exp(-1.0);
    RandomProblemOptions options;
    options.max_weight = 4;
    options.columns = 16;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        const auto best = static_cast<double>(bestByBruteForce(made.problem).value);
        const auto value = static_cast<double>(placeGreedily(made.problem, progress).value);
        EXPECT_GE(value, share * best) << seed;
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
        cheap.addSite(Pose3(), one);
    }
    CellSet four(cells);
    for (std::size_t cell = 2; cell < 6; ++cell) four.set(cell);
    dear.addSite(Pose3(), four);
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
    candidates.addSite(Pose3(), CellSet(2));
    candidates.addSite(Pose3(), first);
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
    candidates.addSite(Pose3(), low);
    apart.addSite(Pose3(), high);
    Problem problem;
    problem.weights = {1, 1, 1, 1};
    problem.kinds = {{&candidates, 1}, {&apart, 1}};
    problem.is_connected = true;
    SilentProgress progress;
    EXPECT_EQ(placeGreedily(problem, progress).chosen, (std::vector<Choice>{{0, 0}}));
    problem.order = {1, 0};
    EXPECT_EQ(placeGreedily(problem, progress).chosen, (std::vector<Choice>{{1, 0}}));
}

class Stopped final : public Progress {
  public:
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
    [[nodiscard]] bool stopped() const override { return true; }
};

TEST(GreedySearch, StoppedItStillPlacesAll) {
    RandomProblemOptions options;
    options.most = 5;
    options.sites = 9;
    Stopped progress;
    const RandomProblem made = randomProblem(1, options);
    const Solution solution = placeGreedily(made.problem, progress);
    EXPECT_EQ(solution.chosen.size(), 5U);
    EXPECT_EQ(solution.value, valueOf(made.problem, solution.chosen));
}

TEST(GreedySearch, HeaviestWeightsDoNotOverflow) {
    CandidateSet candidates(2);
    for (std::size_t cell = 0; cell < 2; ++cell) {
        CellSet one(2);
        one.set(cell);
        candidates.addSite(Pose3(), one);
    }
    Problem problem;
    problem.weights = {1, std::numeric_limits<std::uint32_t>::max() - 2};
    problem.kinds = {{&candidates, 1, 1, 7}};
    problem.demand = 7;
    SilentProgress progress;
    const Solution solution = placeGreedily(problem, progress);
    EXPECT_EQ(solution.chosen, (std::vector<Choice>{{0, 1}}));
    EXPECT_EQ(solution.value, problem.weights[1]);
}

}  // namespace
}  // namespace ispace
