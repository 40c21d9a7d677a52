// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/pair_bound.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "arrange/search/branch_and_bound.h"
#include "arrange/search/search.h"
#include "support/test_problems.h"

namespace ispace {

namespace overlap_bound_test {

/// Six sensors in a hall that they cover in good part.
RandomProblemOptions crowdedOptions(std::uint64_t round) {
    RandomProblemOptions options;
    options.columns = 26;
    options.rows = 20;
    options.sites = 16;
    options.headings = round % 3 == 0 ? 8 : 4;
    options.most = 6;
    options.max_range = round % 2 == 0 ? 9 : 7;
    options.max_weight = round % 5 == 0 ? 9 : 1;
    options.max_achieved = round % 4 == 0 ? 1 : 0;
    if (round % 6 == 0) {  // a sensor covers cells alone all the same
        options.required = 2;
        options.multiplicities = {2};
    }
    return options;
}

struct Case {
    RandomProblem random;
    Solution near;
    Bound plain;
    explicit Case(std::uint64_t round) : random(randomProblem(round, crowdedOptions(round))) {
        SilentProgress progress;
        near = placeGreedily(random.problem, progress);
        plain =
            lagrangianBound(random.problem, near.chosen,
                            {.cut = cut(), .rounds = 40, .stall = 0, .pace = kLongPace}, progress);
    }
    /// Below the known value, so that no bound is cut off there.
    [[nodiscard]] std::uint64_t cut() const { return near.value - near.value / 50; }
    [[nodiscard]] std::uint64_t bound(int rounds) const { return bound(rounds, near.chosen); }
    [[nodiscard]] std::uint64_t bound(int rounds, const std::vector<Choice>& about) const {
        SilentProgress progress;
        return overlapBound(random.problem, plain, about,
                            {.cut = cut(), .rounds = rounds, .stall = 0, .pace = kLongPace},
                            progress);
    }
};

TEST(OverlapBound, IsAboveTheBestAndBelowTheLinearProgram) {
    SilentProgress progress;
    int lower = 0, open = 0;
    for (std::uint64_t round = 0; round < 100; ++round) {
        const Case one(round);
        ASSERT_TRUE(isBoundByOverlaps(one.random.problem));
        const SearchResult best =
            branchAndBound(one.random.problem, one.plain, {one.near, one.plain.value}, 0, progress);
        ASSERT_EQ(best.best.value, best.bound) << round;
        const std::uint64_t bound = one.bound(30);
        ASSERT_GE(bound, best.best.value) << round;
        ASSERT_LE(bound, one.plain.value) << round;
        if (one.plain.value > best.best.value) ++open;
        if (bound < one.plain.value) ++lower;
    }
    EXPECT_GT(open, 12);
    EXPECT_GT(lower, open / 2);
}

TEST(OverlapBound, HoldsHoweverFewRounds) {
    SilentProgress progress;
    for (std::uint64_t round = 100; round < 120; ++round) {
        const Case one(round);
        const SearchResult best =
            branchAndBound(one.random.problem, one.plain, {one.near, one.plain.value}, 0, progress);
        std::uint64_t last = one.plain.value;
        for (const int rounds : {0, 1, 2, 5}) {
            const std::uint64_t bound = one.bound(rounds);
            ASSERT_LE(bound, last) << round;
            ASSERT_GE(bound, best.best.value) << round;
            last = bound;
        }
    }
}

TEST(OverlapBound, HoldsWithManySensorsInAnArea) {
    SilentProgress progress;
    for (std::uint64_t round = 200; round < 220; ++round) {
        const Case one(round);
        const SearchResult best =
            branchAndBound(one.random.problem, one.plain, {one.near, one.plain.value}, 0, progress);
        for (const std::size_t areas : {1U, 2U}) {
            const std::vector<Choice> about(
                one.near.chosen.begin(),
                one.near.chosen.begin() + static_cast<std::ptrdiff_t>(areas));
            ASSERT_GE(one.bound(20, about), best.best.value) << round;
        }
    }
}

TEST(OverlapBound, IsTheSameForAnyNumberOfThreads) {
    for (std::uint64_t round = 0; round < 8; ++round) {
        const Case one(round);
        std::uint64_t alone = 0;
        {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
            alone = one.bound(20);
        }
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 4);
        EXPECT_EQ(one.bound(20), alone) << round;
    }
}

TEST(OverlapBound, LeavesOtherProblemsAlone) {
    RandomProblemOptions few = crowdedOptions(1), two = few, twice = few;
    few.most = 3;
    two.kinds = 2;
    twice.required = 2;
    for (const RandomProblemOptions& options : {few, two, twice})
        EXPECT_FALSE(isBoundByOverlaps(randomProblem(1, options).problem));
}

}  // namespace overlap_bound_test

}  // namespace ispace
