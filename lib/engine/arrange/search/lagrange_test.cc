// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/relaxation.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>
#include <vector>

#include "arrange/search/branch_and_bound.h"
#include "support/test_problems.h"

namespace ispace {
namespace lagrange_test {

Bound boundFor(const Problem& problem, const Solution& best, Progress& progress) {
    return lagrangianBound(problem, best.chosen, {.cut = best.value}, progress);
}

TEST(Lagrange, IsTheSumWhereNothingOverlaps) {
    CandidateSet set(30);
    CellSet first(30), second(30), third(30);
    for (std::size_t i = 0; i < 10; ++i) first.set(i);
    for (std::size_t i = 10; i < 17; ++i) second.set(i);
    for (std::size_t i = 17; i < 20; ++i) third.set(i);
    for (const CellSet& seen : {first, second, third}) set.addSite(seen);
    Problem problem;
    problem.weights.assign(30, 1);
    problem.kinds = {{&set, 2, 1, 1}};
    SilentProgress progress;
    const Solution best{{{0, 0}, {0, 1}}, 17};
    const Bound bound = boundFor(problem, best, progress);
    EXPECT_EQ(bound.value, 17U);
}

TEST(Lagrange, MultipliersFindThatTwoOverlap) {
    // Any two of three see 2 of 3 cells each: all cells, but the sums of two are 4.
    CandidateSet set(3);
    for (std::size_t out = 0; out < 3; ++out) {
        CellSet seen(3);
        for (std::size_t i = 0; i < 3; ++i)
            if (i != out) seen.set(i);
        set.addSite(seen);
    }
    Problem problem;
    problem.weights = {5, 5, 5};
    problem.kinds = {{&set, 2, 1, 1}};
    SilentProgress progress;
    const Bound bound = boundFor(problem, {{{0, 0}, {0, 1}}, 15}, progress);
    EXPECT_EQ(bound.value, 15U);
}

TEST(Lagrange, NothingToPlaceIsWhatIsMet) {
    CandidateSet set(4);
    Problem problem;
    problem.weights = {1, 2, 3, 4};
    problem.achieved = {0, 1, 0, 1};
    problem.kinds = {{&set, 3, 1, 1}};
    SilentProgress progress;
    EXPECT_EQ(boundFor(problem, {{}, 6}, progress).value, 6U);
    problem.kinds.clear();
    EXPECT_EQ(boundFor(problem, {{}, 6}, progress).value, 6U);
}

TEST(Lagrange, HoldsAndSurvivorsHoldTheBest) {
    SilentProgress progress;
    for (std::uint64_t round = 0; round < 120; ++round) {
        const RandomProblem random = variedProblem(round);
        const Problem& problem = random.problem;
        const Solution best = bestByBruteForce(problem);
        const Solution poor{{}, valueOf(problem, {})};
        for (const Solution& known : {best, poor}) {
            const Bound bound = boundFor(problem, known, progress);
            ASSERT_GE(bound.value, best.value) << round;
            ASSERT_EQ(bound.multipliers.size(), problem.cells());
            for (std::size_t i = 0; i < problem.cells(); ++i)
                ASSERT_LE(bound.multipliers[i], std::uint64_t{problem.weights[i]} * bound.scale);
            if (known.value == best.value) continue;
            const auto kept = survivors(problem, bound, known.value);
            for (const Choice& choice : best.chosen)
                ASSERT_TRUE(std::binary_search(kept[choice.kind].begin(), kept[choice.kind].end(),
                                               choice.candidate))
                    << round;
        }
    }
}

TEST(Lagrange, IsNearOnAverage) {
    SilentProgress progress;
    double sum = 0;
    for (std::uint64_t round = 0; round < 60; ++round) {
        const RandomProblem random = randomProblem(round);
        const Solution best = bestByBruteForce(random.problem);
        const Bound bound = boundFor(random.problem, best, progress);
        sum += static_cast<double>(bound.value - best.value) / static_cast<double>(bound.value);
    }
    EXPECT_LT(sum / 60, 0.02);
}

TEST(Lagrange, HoldsWithOddCosts) {
    RandomProblemOptions options;
    options.kinds = 2;
    options.sites = 3;
    options.headings = 3;
    options.most = 2;
    SilentProgress progress;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        RandomProblem random = randomProblem(seed, options);
        random.problem.kinds[1].cost = 0.7;
        random.problem.budget = 2.5;
        const Solution best = bestByBruteForce(random.problem);
        EXPECT_GE(boundFor(random.problem, best, progress).value, best.value);
        for (SensorType& kind : random.problem.kinds) kind.cost *= 1e-5;
        *random.problem.budget *= 1e-5;
        EXPECT_GE(boundFor(random.problem, best, progress).value, best.value);
    }
}

TEST(Lagrange, IsTheSameForAnyNumberOfThreads) {
    RandomProblemOptions options;
    options.columns = 40;
    options.rows = 30;
    options.sites = 200;
    options.headings = 8;
    options.most = 4;
    options.max_range = 9;
    const RandomProblem random = randomProblem(3, options);
    SilentProgress progress;
    const Solution best = placeGreedily(random.problem, progress);
    const auto bounded = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return boundFor(random.problem, best, progress);
    };
    const Bound one = bounded(1), two = bounded(2);
    EXPECT_EQ(one.value, two.value);
    EXPECT_EQ(one.multipliers, two.multipliers);
    EXPECT_EQ(one.survivors, two.survivors);
    EXPECT_LT(one.value, random.problem.totalWeight());
}

using Counts = std::vector<std::size_t>;

/// Creates six candidates with empty views.
CandidateSet sixCandidates() {
    CandidateSet candidates(1);
    for (int i = 0; i < 6; ++i) candidates.addSite(CellSet(1));
    return candidates;
}

std::vector<Choice> choicesOf(const Counts& counts) {
    std::vector<Choice> chosen;
    for (std::size_t k = 0; k < counts.size(); ++k)
        for (std::size_t i = 0; i < counts[k]; ++i) chosen.push_back({k, i});
    return chosen;
}

TEST(CountChoice, TakesWhatDecimalsAddUpTo) {
    const CandidateSet candidates = sixCandidates();
    Problem problem;
    problem.weights = {1};
    problem.kinds = {{&candidates, 6, 0.1, 1}, {&candidates, 6, 0.2, 1}};
    problem.budget = 0.3;
    const CountChoice choice(problem);
    EXPECT_EQ(choice.ways(), (std::vector<Counts>{{3, 0}, {2, 0}, {1, 1}, {0, 1}}));
    EXPECT_EQ(choice.total(), 3U);
}

TEST(CountChoice, SmallCostsCountBesideLargeOnes) {
    const CandidateSet candidates = sixCandidates();
    Problem problem;
    problem.weights = {1};
    problem.kinds = {{&candidates, 6, 1e6, 1}, {&candidates, 6, 0.001, 1}};
    problem.budget = 1e6 + 0.002;
    const CountChoice choice(problem);
    EXPECT_EQ(choice.ways(), (std::vector<Counts>{{1, 2}, {0, 6}}));
}

TEST(CountChoice, WaysAreFeasibleAndHoldAllThatIs) {
    const CandidateSet candidates = sixCandidates();
    std::mt19937_64 random(11);
    const double costs[] = {1, 0.1, 0.2, 0.7, 1.0 / 3, 2.5, 0.001, 1e6, 999'999.999, 1e-6};
    for (int round = 0; round < 200; ++round) {
        Problem problem;
        problem.weights = {1};
        for (int k = 0; k < 3; ++k)
            problem.kinds.push_back(
                {&candidates, static_cast<int>(1 + random() % 5), costs[random() % 10], 1});
        const Counts afforded = {random() % 4, random() % 4, random() % 4};
        problem.budget = normaliseCost(costOf(problem, choicesOf(afforded)));
        const CountChoice choice(problem);
        for (const Counts& way : choice.ways())
            ASSERT_TRUE(isFeasible(problem, choicesOf(way))) << round;
        for (std::size_t i = 0; i < 6 * 6 * 6; ++i) {
            const Counts counts = {i % 6, i / 6 % 6, i / 36};
            if (!isFeasible(problem, choicesOf(counts))) continue;
            ASSERT_TRUE(std::any_of(choice.ways().begin(), choice.ways().end(),
                                    [&](const Counts& way) {
                                        return counts[0] <= way[0] && counts[1] <= way[1] &&
                                               counts[2] <= way[2];
                                    }))
                << round;
        }
    }
}

}  // namespace lagrange_test
}  // namespace ispace
