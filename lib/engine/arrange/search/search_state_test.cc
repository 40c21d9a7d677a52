// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/greedy_search.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "arrange/search/problem.h"
#include "support/test_problems.h"

namespace ispace {
namespace search_state_test {

RandomProblemOptions mixed() {
    RandomProblemOptions options;
    options.kinds = 2;
    options.max_weight = 9;
    options.required = 4;
    options.max_achieved = 6;
    options.multiplicities = {1, 6};
    return options;
}

TEST(CoverageState, ValueAndPricesHoldWhileSensorsComeAndGo) {
    test_problems::Random random(5);
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const RandomProblem made = randomProblem(seed, mixed());
        const Problem& problem = made.problem;
        const auto parts = partialWeights(problem);
        EXPECT_EQ(parts, problem.weights);  // small enough without scaling
        CoverageState state(problem, parts);
        std::vector<std::uint32_t> gains;
        for (int step = 0; step < 30; ++step) {
            if (state.chosen().size() > 4 || (random() % 3 == 0 && !state.chosen().empty()))
                state.removeAt(random() % state.chosen().size());
            const std::size_t kind = random() % 2;
            const Choice next{kind, random() % problem.kinds[kind].candidates->size()};
            const bool is_new = !state.holds(next);
            state.marginalGains(kind, Measure::Full, gains);
            const auto achieved =
                problem.kinds[kind].candidates->weigh(next.candidate, WeightSums(gains));
            state.marginalGains(kind, Measure::Partial, gains);
            const auto more =
                problem.kinds[kind].candidates->weigh(next.candidate, WeightSums(gains));
            const auto value = state.value(), had = state.partialValue();
            state.insert(random() % (state.chosen().size() + 1), next);
            EXPECT_EQ(state.value(), value + (is_new ? achieved : 0U));
            EXPECT_EQ(state.partialValue(), had + (is_new ? more : 0U));
            EXPECT_EQ(state.value(), valueOf(problem, state.chosen())) << seed;
        }
        while (!state.chosen().empty()) state.removeAt(0);
        const CoverageState fresh(problem, parts);
        EXPECT_EQ(state.value(), fresh.value());
        EXPECT_EQ(state.partialValue(), fresh.partialValue());
    }
}

TEST(CoverageState, StepsCountByTheSensorsThatAreLacking) {
    CandidateSet candidates(7);
    CellSet last(7);
    last.set(6);
    candidates.addSite(last);
    Problem problem;
    problem.weights = {1, 1, 1, 1, 1, 1, 3};
    problem.achieved = {0, 1, 2, 3, 4, 9, 0};
    problem.required = 4;
    problem.kinds = {{&candidates, 1, 1, 1}, {&candidates, 1, 1, 3}, {&candidates, 1, 1, 5}};
    const auto parts = partialWeights(problem);
    CoverageState state(problem, parts);
    std::vector<std::uint32_t> gains;
    state.stepGains(0, 9, gains);
    const std::uint32_t whole = gains[3];
    EXPECT_EQ(whole % 840, 0U);
    EXPECT_LT(std::uint64_t{whole} * 9, std::uint64_t{1} << 32U);
    EXPECT_GT(std::uint64_t{whole + 840} * 9, std::uint64_t{1} << 32U);
    using Prices = std::vector<std::uint32_t>;
    EXPECT_EQ(gains, (Prices{whole / 4, whole / 3, whole / 2, whole, 0, 0, whole / 4 * 3}));
    state.stepGains(0, 2, gains);
    EXPECT_EQ(gains, (Prices{0, whole / 3, whole / 2, whole, 0, 0, 0}));
    state.stepGains(1, 1, gains);
    EXPECT_EQ(gains, (Prices{whole / 2, whole, whole, whole, 0, 0, whole / 2 * 3}));
    state.add({1, 0});
    state.stepGains(1, 0, gains);
    EXPECT_EQ(gains, (Prices{0, whole, whole, whole, 0, 0, 3 * whole}));
    state.stepGains(2, 0, gains);
    EXPECT_EQ(gains, (Prices{whole, whole, whole, whole, 0, 0, 3 * whole}));
    EXPECT_TRUE(takesSteps(problem));
    problem.kinds = {{&candidates, 1, 1, 4}, {&candidates, 1, 1, 5}};
    EXPECT_FALSE(takesSteps(problem));
    // Without room for a factor the weights stay.
    problem.weights = {std::numeric_limits<std::uint32_t>::max() - 1, 1, 0, 0, 0, 0, 0};
    problem.achieved.clear();
    problem.kinds = {{&candidates, 1, 1, 1}};
    CoverageState(problem, partialWeights(problem)).stepGains(0, 3, gains);
    EXPECT_EQ(gains[0], problem.weights[0] / 4);
}

TEST(CoverageState, PartsOfLargeWeightsAreScaledToFit) {
    CandidateSet candidates(3);
    CellSet all(3);
    for (std::size_t cell = 0; cell < 3; ++cell) all.set(cell);
    candidates.addSite(all);
    Problem problem;
    problem.weights = {std::numeric_limits<std::uint32_t>::max() - 1, 1, 0};
    problem.required = 8;
    problem.kinds = {{&candidates, 1, 1, 1}};
    EXPECT_EQ(partialWeights(problem), problem.weights);
    problem.kinds.push_back({&candidates, 1, 1, 8});
    const auto parts = partialWeights(problem);
    EXPECT_LT((std::uint64_t{parts[0]} + parts[1]) * 8, std::uint64_t{1} << 32U);
    EXPECT_GT(parts[0], std::uint32_t{1} << 27U);
    EXPECT_EQ(parts[1], 1U);
    EXPECT_EQ(parts[2], 0U);
}

TEST(CoverageState, LimitsFollowOrderAndCandidates) {
    const CandidateSet none(1);
    CandidateSet one(1);
    one.addSite(CellSet(1));
    Problem problem;
    problem.weights = {1};
    problem.kinds = {{&one, 5}, {&none, 2}, {&one, 1}};
    EXPECT_EQ(limitsOf(problem), (std::vector<int>{5, 0, 1}));
    problem.order = {0, 1, 0, 2, 2};
    EXPECT_EQ(limitsOf(problem), (std::vector<int>{2, 0, 1}));
}

TEST(Connection, IsJoinedByThatWhichMakesItConnected) {
    RandomProblemOptions options;
    options.max_range = 3;
    options.is_connected = true;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        options.has_standing = seed % 2 == 0;
        RandomProblem made = randomProblem(seed, options);
        test_problems::Random random(seed);
        if (seed % 3 > 0) {  // two regions, which sensors may join
            made.problem.regions.resize(made.problem.cells());
            const std::size_t split = random() % made.problem.cells();
            for (std::size_t i = split; i < made.problem.cells(); ++i) made.problem.regions[i] = 1;
        }
        std::vector<Choice> chosen;
        for (int i = 0; i < 4; ++i) {
            const Connection connection(made.problem, chosen);
            EXPECT_EQ(connection.isWhole(), isConnected(made.problem, chosen));
            for (std::size_t c = 0; c < made.candidates[0]->size(); ++c) {
                auto more = chosen;
                more.push_back({0, c});
                EXPECT_EQ(connection.isJoinedBy({0, c}), isConnected(made.problem, more)) << seed;
            }
            chosen.push_back({0, random() % made.candidates[0]->size()});
        }
    }
}

}  // namespace search_state_test
}  // namespace ispace
