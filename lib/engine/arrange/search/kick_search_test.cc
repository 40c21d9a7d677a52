// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/local_search.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "arrange/search/search.h"
#include "support/test_problems.h"

namespace ispace {

namespace kick_search_test {

Solution kicked(const Problem& problem, const Solution& start, const KickOptions& options = {}) {
    SilentProgress progress;
    return iteratedLocalSearch(problem, start, options, progress);
}

Solution greedyStart(const Problem& problem) {
    SilentProgress progress;
    return placeFeasibly(problem, progress);
}

/// Twelve sensors in a hall that they cover in good part.
RandomProblem crowded(std::uint64_t seed) {
    RandomProblemOptions options;
    options.sites = 80;
    options.columns = 44;
    options.rows = 32;
    options.most = 12;
    options.max_range = 9;
    return randomProblem(seed, options);
}

TEST(KickSearch, FindsTheOptimumOfMostProblems) {
    int found = 0;
    for (std::uint64_t round = 0; round < 60; ++round) {
        RandomProblemOptions options = variedOptions(round);
        options.is_connected = round % 7 == 0;
        const RandomProblem random = randomProblem(round, options);
        const Solution start = greedyStart(random.problem);
        const Solution end = kicked(random.problem, start);
        const std::uint64_t best = bestByBruteForce(random.problem).value;
        ASSERT_GE(end.value, start.value) << round;
        ASSERT_LE(end.value, best) << round;
        ASSERT_EQ(end.value, valueOf(random.problem, end.chosen)) << round;
        ASSERT_TRUE(isFeasible(random.problem, end.chosen)) << round;
        if (end.value == best) ++found;
    }
    EXPECT_GE(found, 56);
}

TEST(KickSearch, LeavesLocalOptima) {
    SilentProgress progress;
    int better = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const RandomProblem random = crowded(seed);
        const Solution swapped =
            improveBySwaps(random.problem, greedyStart(random.problem), {.starts = 0}, progress);
        const Solution end = kicked(random.problem, swapped);
        ASSERT_GE(end.value, swapped.value) << seed;
        if (end.value > swapped.value) ++better;
    }
    EXPECT_GE(better, 5);
}

TEST(KickSearch, IsTheSameForAnyNumberOfThreads) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        const RandomProblem random = crowded(seed);
        const Solution start = greedyStart(random.problem);
        Solution alone;
        {
            const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
            alone = kicked(random.problem, start, {.seed = seed});
        }
        const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 8);
        EXPECT_EQ(kicked(random.problem, start, {.seed = seed}).chosen, alone.chosen) << seed;
    }
}

TEST(KickSearch, EndsWhereItIsEnough) {
    const RandomProblem random = crowded(2);
    const Solution start = greedyStart(random.problem);
    const Solution most = kicked(random.problem, start);
    ASSERT_GT(most.value, start.value + 1);
    EXPECT_EQ(kicked(random.problem, start, {.enough = start.value}).chosen, start.chosen);
    EXPECT_EQ(kicked(random.problem, start, {.rounds = 0}).chosen, start.chosen);
    const Solution end = kicked(random.problem, start, {.enough = start.value + 1});
    EXPECT_GT(end.value, start.value);
}

TEST(KickSearch, StoppedItKeepsWhatItHas) {
    const RandomProblem random = crowded(3);
    const Solution start = greedyStart(random.problem);
    for (const int times : {0, 1, 10, 100, 1000}) {
        StopWhen progress(afterAsking(times));
        const Solution end = iteratedLocalSearch(random.problem, start, {}, progress);
        EXPECT_GE(end.value, start.value);
        EXPECT_EQ(end.value, valueOf(random.problem, end.chosen));
        EXPECT_EQ(progress.begun, progress.ended);
    }
}

TEST(KickSearch, TrivialProblems) {
    const CandidateSet none(2);
    CandidateSet one(2);
    one.addSite(CellSet(2));
    Problem problem;
    problem.weights = {1, 1};
    EXPECT_TRUE(kicked(problem, {}).chosen.empty());
    problem.kinds = {{&none, 3}, {&one, 3}};
    const Solution doubled{{{1, 0}, {1, 0}, {1, 0}}, 0};
    EXPECT_EQ(kicked(problem, doubled).value, 0U);
}

}  // namespace kick_search_test

}  // namespace ispace
