// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <limits>
#include <string_view>

#include "arrange/search/search.h"
#include "base/number.h"
#include "support/test_problems.h"

namespace ispace {
namespace minimum_cost_test {

/// Returns the minimum cost of a set of that value; infinite if there is no such set.
double leastCost(const Problem& problem, std::uint64_t wanted) {
    double least = std::numeric_limits<double>::infinity();
    std::vector<Choice> chosen;
    test_problems::forEachSet(problem, chosen, 0, 0, problem.kinds[0].most,
                              [&](const std::vector<Choice>& set) {
                                  if (isFeasible(problem, set) && valueOf(problem, set) >= wanted)
                                      least = std::min(least, costOf(problem, set));
                              });
    return least;
}

TEST(MinimumCost, EqualsBruteForce) {
    SilentProgress progress;
    int reached = 0;
    for (std::uint64_t round = 0; round < 60; ++round) {
        RandomProblem random = variedProblem(round);
        Problem& problem = random.problem;
        if (round % 3 == 2) problem.kinds[1].cost = round % 2 == 0 ? 1.5 : 0.4;
        const std::uint64_t best = bestByBruteForce(problem).value;
        for (const std::uint64_t wanted : {best / 2, best * 9 / 10, best, best + 1}) {
            const double least = leastCost(problem, wanted);
            for (const Optimizer optimizer :
                 {Optimizer::Greedy, Optimizer::Swap, Optimizer::Exact}) {
                SearchOptions options;
                options.optimizer = optimizer;
                options.swap.starts = 3;
                const MinimumCostCover cover = minimumCostCover(problem, wanted, options, progress);
                ASSERT_TRUE(isFeasible(problem, cover.result.best.chosen));
                ASSERT_EQ(valueOf(problem, cover.result.best.chosen), cover.result.best.value);
                ASSERT_DOUBLE_EQ(costOf(problem, cover.result.best.chosen), cover.cost);
                ASSERT_LE(cover.cost_bound, least + 1e-9) << round << ' ' << wanted;
                if (cover.is_reached) {
                    ++reached;
                    ASSERT_GE(cover.result.best.value, wanted);
                    ASSERT_GE(cover.cost, least - 1e-9);
                } else {
                    ASSERT_TRUE(optimizer != Optimizer::Exact || least > 1e9) << round;
                }
                if (optimizer != Optimizer::Exact || !cover.is_reached) continue;
                ASSERT_NEAR(cover.cost, least, 1e-9) << round << ' ' << wanted;
                ASSERT_NEAR(cover.cost_bound, least, 1e-9) << round << ' ' << wanted;
            }
        }
    }
    EXPECT_GT(reached, 400);
}

TEST(MinimumCost, EqualsBruteForceWithCostsFarApart) {
    SilentProgress progress;
    const double costs[] = {1e6, 999'999.999, 0.001, 0.1, 0.2, 1.0 / 3};
    SearchOptions options;
    options.optimizer = Optimizer::Exact;
    options.swap.starts = 1;
    for (std::uint64_t round = 0; round < 72; ++round) {
        RandomProblem random = variedProblem(3 * round + 2);
        Problem& problem = random.problem;
        problem.kinds[0].cost = costs[round % 6];
        problem.kinds[1].cost = costs[round / 6 % 6];
        problem.budget.reset();
        if (round % 4 == 3) problem.budget = problem.kinds[0].cost + problem.kinds[1].cost;
        const std::uint64_t best = bestByBruteForce(problem).value;
        for (const std::uint64_t wanted : {best / 2, best * 9 / 10, best}) {
            const double least = leastCost(problem, wanted);
            const MinimumCostCover cover = minimumCostCover(problem, wanted, options, progress);
            ASSERT_TRUE(cover.is_reached);
            ASSERT_EQ(cover.cost, normaliseCost(least)) << round << ' ' << wanted;
            ASSERT_EQ(cover.cost_bound, cover.cost) << round << ' ' << wanted;
        }
    }
}

/// Appends a candidate that sees these cells.
void addCandidate(CandidateSet& set, const std::vector<std::size_t>& cells) {
    CellSet seen(set.cells());
    for (const std::size_t cell : cells) seen.set(cell);
    set.addSite(seen);
}

TEST(MinimumCost, SmallCostsCountBesideLargeOnes) {
    CandidateSet large(10), small(10);
    addCandidate(large, {0, 1, 2, 3, 4, 5, 6, 7, 8});
    addCandidate(small, {9});
    Problem problem;
    problem.weights.assign(10, 1);
    problem.kinds = {{&large, 1, 1e6, 1}, {&small, 1, 0.001, 1}};
    SilentProgress progress;
    const MinimumCostCover cover = minimumCostCover(problem, 10, {}, progress);
    EXPECT_EQ(cover.cost, 1000000.001);
    EXPECT_EQ(cover.cost_bound, 1000000.001);
}

TEST(MinimumCost, ManyOfEqualCostHideNothingCheaper) {
    // Greedy takes three of each group of eight, although two are enough: 1700 instead of 1500.
    constexpr std::size_t kGroups = 200, kOwn = 300, kOthers = 800;
    constexpr std::size_t kCells = 8 * kGroups + kOwn + kOthers;
    CandidateSet first(kCells), second(kCells);
    for (std::size_t a = 0; a < 8 * kGroups; a += 8) {
        const std::size_t b = a + 4;
        addCandidate(first, {a});
        addCandidate(first, {b});
        addCandidate(first, {a + 1, a + 2, a + 3, b + 1, b + 2, b + 3});
        addCandidate(first, {a, a + 1, a + 2, a + 3});
        addCandidate(first, {b, b + 1, b + 2, b + 3});
    }
    for (std::size_t i = 0; i < kOwn; ++i) addCandidate(first, {8 * kGroups + i});
    for (std::size_t i = 0; i < kOthers; ++i) addCandidate(second, {8 * kGroups + kOwn + i});
    Problem problem;
    problem.weights.assign(kCells, 1);
    problem.kinds = {{&first, 1000, 1, 1}, {&second, 1000, 1, 1}};
    SilentProgress progress;
    SearchOptions options;
    options.optimizer = Optimizer::Greedy;
    const MinimumCostCover cover = minimumCostCover(problem, kCells, options, progress);
    EXPECT_EQ(cover.cost, 1700);
    EXPECT_LE(cover.cost_bound, 1500);
    EXPECT_GE(cover.cost_bound, 1300);
}

TEST(MinimumCost, EvenLevelsHaveFewDigits) {
    // More than 4000 sums, and tight bounds, as views do not overlap.
    constexpr std::size_t kOfEach = 30;
    std::vector<CandidateSet> sets(3, CandidateSet(3 * kOfEach));
    for (std::size_t i = 0; i < 3 * kOfEach; ++i) addCandidate(sets[i / kOfEach], {i});
    Problem problem;
    problem.weights.assign(3 * kOfEach, 1);
    problem.kinds = {{&sets[0], 30, 1.2345, 1}, {&sets[1], 30, 1.41421, 1}};
    problem.kinds.push_back({&sets[2], 30, 1.73205, 1});
    SilentProgress progress;
    const double least = 30 * 1.2345 + 30 * 1.41421 + 5 * 1.73205;
    for (const Optimizer optimizer : {Optimizer::Greedy, Optimizer::Exact}) {
        SearchOptions options;
        options.optimizer = optimizer;
        options.swap.starts = 2;
        const MinimumCostCover cover = minimumCostCover(problem, 65, options, progress);
        EXPECT_LE(cover.cost_bound, least);
        EXPECT_GE(cover.cost_bound, 0.99 * least);
        EXPECT_LE(formatDouble(cover.cost_bound).size(), 7U);
        EXPECT_EQ(cover.cost, normaliseCost(least));
    }
}

TEST(MinimumCost, WithoutLimitStopsWhereItIsEnough) {
    RandomProblemOptions options;
    options.columns = 24;
    options.rows = 20;
    options.sites = 60;
    options.most = 5000;
    const RandomProblem random = randomProblem(2, options);
    SilentProgress progress;
    const std::uint64_t wanted = random.problem.totalWeight() * 6 / 10;
    const MinimumCostCover cover = minimumCostCover(random.problem, wanted, {}, progress);
    EXPECT_TRUE(cover.is_reached);
    EXPECT_GE(cover.result.best.value, wanted);
    EXPECT_LT(cover.cost, 30);
    EXPECT_GE(cover.cost, cover.cost_bound);
    EXPECT_GE(cover.cost_bound, cover.cost * 0.6);
}

bool onceSwapsBegin(const StopWhen& told) {
    return told.phases.find("improving ") != std::string::npos;
}

TEST(MinimumCost, HasBoundsBeforeItLooksForLess) {
    RandomProblemOptions options;
    options.columns = 50;
    options.rows = 50;
    options.sites = 120;
    options.max_range = 12;
    options.most = 1000;
    int stopped = 0;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        const RandomProblem random = randomProblem(seed, options);
        const std::uint64_t total = random.problem.totalWeight();
        StopWhen progress(onceSwapsBegin);
        const MinimumCostCover cover =
            minimumCostCover(random.problem, total * 7 / 10, {}, progress);
        ASSERT_TRUE(cover.is_reached);
        EXPECT_EQ(cover.result.is_complete, !progress.stopped());
        EXPECT_GE(cover.cost_bound, 0.8 * cover.cost);
        EXPECT_LT(cover.result.bound, total * 9 / 10);
        if (progress.stopped()) ++stopped;
    }
    EXPECT_GE(stopped, 1);
}

TEST(MinimumCost, GreedilyRunsNoSwaps) {
    const RandomProblem random = randomProblem(5);
    StopWhen progress(onceSwapsBegin);
    SearchOptions options;
    options.optimizer = Optimizer::Greedy;
    const std::uint64_t wanted = random.problem.totalWeight() / 10;
    const MinimumCostCover cover = minimumCostCover(random.problem, wanted, options, progress);
    EXPECT_TRUE(cover.is_reached);
    EXPECT_FALSE(progress.stopped());
}

TEST(MinimumCost, OutOfReachGivesTheBestWithoutIdleSensors) {
    CandidateSet set(10);
    for (std::size_t first = 0; first < 6; first += 2) {
        CellSet seen(10);
        for (std::size_t i = first; i < first + 3; ++i) seen.set(i);
        set.addSite(seen);
        set.addSite(seen);
    }
    Problem problem;
    problem.weights.assign(10, 1);
    problem.kinds = {{&set, 1000, 2, 1}};
    SilentProgress progress;
    const MinimumCostCover cover = minimumCostCover(problem, 10, {}, progress);
    EXPECT_FALSE(cover.is_reached);
    EXPECT_EQ(cover.result.best.value, 7U);
    EXPECT_EQ(cover.result.best.chosen.size(), 3U);
    EXPECT_EQ(cover.result.bound, 7U);
    EXPECT_DOUBLE_EQ(cover.cost, 6);
}

TEST(MinimumCost, WhatStandsMayBeEnough) {
    CandidateSet set(2);
    Problem problem;
    problem.weights = {1, 1};
    problem.achieved = {1, 0};
    problem.kinds = {{&set, 5, 1, 1}};
    SilentProgress progress;
    const MinimumCostCover cover = minimumCostCover(problem, 1, {}, progress);
    EXPECT_TRUE(cover.is_reached);
    EXPECT_TRUE(cover.result.best.chosen.empty());
    EXPECT_EQ(cover.cost_bound, 0);
}

}  // namespace minimum_cost_test
}  // namespace ispace
