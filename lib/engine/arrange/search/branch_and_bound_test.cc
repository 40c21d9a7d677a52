// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/branch_and_bound.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>

#include "arrange/search/branch_node.h"
#include "arrange/search/relaxation.h"
#include "support/test_problems.h"

namespace ispace {

namespace branch_and_bound_test {

using List = std::vector<std::uint32_t>;

std::shared_ptr<const ReducedProblem> problemOf(std::size_t cells) {
    ReducedProblem problem;
    problem.weights.assign(cells, 1);
    problem.needs.assign(cells, 1);
    return std::make_shared<const ReducedProblem>(std::move(problem));
}

BranchNode nodeOf(std::uint64_t bound, std::shared_ptr<const ReducedProblem> problem) {
    BranchNode node;
    node.problem = std::move(problem);
    node.multipliers = std::make_shared<const List>();
    node.groups.push_back({0, 1, std::make_shared<const List>(List{1, 2})});
    node.bound = bound;
    return node;
}

std::vector<std::uint64_t> boundsOf(const std::vector<BranchNode>& nodes) {
    std::vector<std::uint64_t> bounds;
    for (const BranchNode& node : nodes) bounds.push_back(node.bound);
    return bounds;
}

TEST(OpenNodes, HighestBoundsComeFirst) {
    OpenNodes open(1'000'000);
    for (const std::uint64_t bound : {5U, 9U, 7U, 9U, 1U}) open.add(nodeOf(bound, problemOf(1)));
    EXPECT_EQ(open.bound(), 9U);
    EXPECT_EQ(boundsOf(open.take(3)), (std::vector<std::uint64_t>{9, 9, 7}));
    EXPECT_EQ(open.bound(), 5U);
    EXPECT_EQ(open.dropUpTo(0), 0U);
    EXPECT_EQ(open.dropUpTo(3), 1U);
    EXPECT_EQ(boundsOf(open.take(3)), (std::vector<std::uint64_t>{5}));
    EXPECT_TRUE(open.empty());
    EXPECT_EQ(open.bytes(), 0U);
}

TEST(OpenNodes, NewestComeFirstWhereMemoryIsFull) {
    const auto problem = problemOf(1000);
    OpenNodes open(3 * problem->bytes());
    for (const std::uint64_t bound : {5U, 9U, 7U}) open.add(nodeOf(bound, problemOf(1000)));
    EXPECT_EQ(boundsOf(open.take(8)), (std::vector<std::uint64_t>{7}));  // large: one at a time
    EXPECT_EQ(boundsOf(open.take(8)), (std::vector<std::uint64_t>{9}));  // no longer full
    open.add(nodeOf(4, problemOf(1000)));
    open.add(nodeOf(3, problemOf(1000)));
    EXPECT_EQ(boundsOf(open.take(8)), (std::vector<std::uint64_t>{3}));
    EXPECT_EQ(open.bound(), 5U);
}

TEST(OpenNodes, WhatIsSharedCountsOnce) {
    const auto problem = problemOf(1000);
    OpenNodes open(std::size_t{1} << 30U);
    const BranchNode node = nodeOf(3, problem);
    open.add(node);
    const std::size_t one = open.bytes();
    EXPECT_GT(one, problem->bytes());
    open.add(node);
    EXPECT_LT(open.bytes() - one, problem->bytes());
    open.take(1);
    EXPECT_EQ(open.bytes(), one);
    open.take(1);
    EXPECT_EQ(open.bytes(), 0U);
}

/// Searches without a known solution, with a bound of few rounds, so that the tree has work to do.
SearchResult searchTree(const Problem& problem, double gap, Progress& progress,
                        std::size_t max_bytes = kMaxTreeBytes) {
    SearchResult known;
    known.best = {{}, valueOf(problem, {})};
    const Bound bound =
        lagrangianBound(problem, {}, {.cut = known.best.value, .rounds = 1}, progress);
    known.bound = bound.value;
    return branchAndBound(problem, bound, known, gap, progress,
                          std::numeric_limits<std::uint64_t>::max(), max_bytes);
}

TEST(BranchAndBound, EqualsBruteForce) {
    SilentProgress progress;
    for (std::uint64_t round = 0; round < 300; ++round) {
        const RandomProblem random = variedProblem(round);
        const std::uint64_t best = bestByBruteForce(random.problem).value;
        const SearchResult result = searchTree(random.problem, 0, progress);
        ASSERT_EQ(result.best.value, best) << round;
        ASSERT_EQ(result.bound, best) << round;
        ASSERT_TRUE(result.is_complete);
        ASSERT_EQ(valueOf(random.problem, result.best.chosen), best);
        ASSERT_TRUE(isFeasible(random.problem, result.best.chosen));
    }
}

TEST(BranchAndBound, EqualsBruteForceWhereSetsAreTooManyForOneNode) {
    SilentProgress progress;
    for (std::uint64_t round = 0; round < 12; ++round) {
        RandomProblemOptions options = variedOptions(4 * round);
        options.kinds = 1;
        options.sites = 20;
        options.most = 3;
        const RandomProblem random = randomProblem(round, options);
        const std::uint64_t best = bestByBruteForce(random.problem).value;
        const SearchResult result = searchTree(random.problem, 0, progress);
        ASSERT_EQ(result.best.value, best) << round;
        ASSERT_EQ(result.bound, best) << round;
    }
}

TEST(BranchAndBound, EqualsBruteForceWhereViewsHangTogether) {
    SilentProgress progress;
    for (std::uint64_t round = 0; round < 120; ++round) {
        RandomProblemOptions options = variedOptions(round);
        options.is_connected = true;
        options.max_range = 3;
        const RandomProblem random = randomProblem(round, options);
        const std::uint64_t best = bestByBruteForce(random.problem).value;
        const SearchResult result = searchTree(random.problem, 0, progress);
        ASSERT_EQ(result.best.value, best) << round;
        ASSERT_EQ(result.bound, best) << round;
        ASSERT_TRUE(isFeasible(random.problem, result.best.chosen)) << round;
    }
}

RandomProblem largerProblem(std::uint64_t seed) {
    RandomProblemOptions options;
    options.columns = 24;
    options.rows = 20;
    options.sites = 40;
    options.headings = 6;
    options.most = 4;
    options.max_range = 7;
    return randomProblem(seed, options);
}

TEST(BranchAndBound, KeepsTheGap) {
    SilentProgress progress;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        const RandomProblem random = largerProblem(seed);
        const SearchResult exact = searchTree(random.problem, 0, progress);
        ASSERT_EQ(exact.best.value, exact.bound);
        const SearchResult near = searchTree(random.problem, 0.05, progress);
        EXPECT_GE(near.bound, exact.bound);
        EXPECT_LE(static_cast<double>(near.bound - near.best.value),
                  0.05 * static_cast<double>(near.bound));
    }
}

TEST(BranchAndBound, WithAGapTheBoundIsTheBestKnown) {
    SilentProgress progress;
    std::size_t lower = 0;  // than the gap would let it be
    for (std::uint64_t round = 0; round < 200; ++round) {
        const RandomProblem random = variedProblem(round);
        const std::uint64_t best = bestByBruteForce(random.problem).value;
        for (const double gap : {0.03, 0.2, 0.5}) {
            const SearchResult near = searchTree(random.problem, gap, progress);
            ASSERT_GE(near.bound, best) << round;
            ASSERT_LE(near.best.value, best) << round;
            const auto value = static_cast<double>(near.best.value);
            ASSERT_LE(static_cast<double>(near.bound) * (1 - gap), value) << round;
            if (static_cast<double>(near.bound + 1) * (1 - gap) <= value) ++lower;
        }
    }
    EXPECT_GT(lower, 100U);
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        const RandomProblem random = largerProblem(seed);
        const std::uint64_t best = searchTree(random.problem, 0, progress).best.value;
        // Something less is known, and the best is ruled out by the gap.
        for (const std::uint64_t less : {best / 50, best / 20, best / 10}) {
            SearchResult known;
            known.best = {{}, best - less};
            const Bound bound =
                lagrangianBound(random.problem, {}, {.cut = best - less, .rounds = 1}, progress);
            known.bound = bound.value;
            const double gap = static_cast<double>(less + 1) / static_cast<double>(best);
            ASSERT_GE(branchAndBound(random.problem, bound, known, gap, progress).bound, best);
        }
    }
}

TEST(BranchAndBound, LittleMemoryIsEnough) {
    SilentProgress progress;
    for (std::uint64_t round = 0; round < 60; ++round) {
        const RandomProblem random = variedProblem(round);
        const std::uint64_t best = bestByBruteForce(random.problem).value;
        const SearchResult result = searchTree(random.problem, 0, progress, 1);
        ASSERT_EQ(result.best.value, best) << round;
        ASSERT_EQ(result.bound, best) << round;
    }
    const RandomProblem random = largerProblem(5);
    const SearchResult much = searchTree(random.problem, 0, progress);
    for (const std::size_t max_bytes : {1U, 30'000U}) {
        const SearchResult little = searchTree(random.problem, 0, progress, max_bytes);
        EXPECT_EQ(little.best.value, much.best.value);
        EXPECT_EQ(little.bound, much.bound);
    }
}

TEST(BranchAndBound, IsTheSameForAnyNumberOfThreads) {
    const RandomProblem random = largerProblem(11);
    SilentProgress progress;
    for (const std::size_t max_bytes : {kMaxTreeBytes, std::size_t{20'000}})
        for (const double gap : {0.0, 0.02}) {
            const auto searched = [&](std::size_t threads) {
                const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                                  threads);
                return searchTree(random.problem, gap, progress, max_bytes);
            };
            const SearchResult one = searched(1), two = searched(2);
            EXPECT_EQ(one.best.chosen, two.best.chosen);
            EXPECT_EQ(one.bound, two.bound);
        }
}

TEST(BranchAndBound, StoppedItStillBounds) {
    const RandomProblem random = largerProblem(5);
    SilentProgress silent;
    const SearchResult exact = searchTree(random.problem, 0, silent);
    for (const int steps : {3, 12, 40}) {
        StopWhen progress([steps](const StopWhen& told) { return told.done >= steps; });
        const SearchResult result = searchTree(random.problem, 0, progress);
        EXPECT_GE(result.bound, exact.best.value);
        EXPECT_LE(result.best.value, exact.best.value);
        EXPECT_TRUE(!result.is_complete || result.best.value == exact.best.value);
    }
}

TEST(BranchAndBound, StoppedInTheMidstOfANodeItStillBounds) {
    SilentProgress silent;
    const RandomProblem random = largerProblem(5);
    const SearchResult exact = searchTree(random.problem, 0, silent);
    std::size_t stopped = 0;
    for (int asked = 1; asked < 900; asked += 1 + asked / 20) {
        StopWhen progress(afterAsking(asked - 1));  // in the midst of a node
        const SearchResult result = searchTree(random.problem, 0, progress);
        ASSERT_GE(result.bound, exact.best.value) << asked;
        ASSERT_EQ(valueOf(random.problem, result.best.chosen), result.best.value) << asked;
        ASSERT_TRUE(!result.is_complete || result.bound == result.best.value) << asked;
        if (!result.is_complete) ++stopped;
    }
    EXPECT_GT(stopped, 30U);
}

TEST(BranchAndBound, EndsWhenItHasEnough) {
    const RandomProblem random = largerProblem(5);
    SilentProgress progress;
    SearchResult known;
    const Bound bound = lagrangianBound(random.problem, {}, {.cut = 99, .rounds = 2}, progress);
    known.best = {{}, 99};
    known.bound = bound.value;
    const SearchResult result = branchAndBound(random.problem, bound, known, 0, progress, 100);
    EXPECT_GE(result.best.value, 100U);
    EXPECT_EQ(valueOf(random.problem, result.best.chosen), result.best.value);
}

TEST(ReducedProblem, PricesStayTheSame) {
    for (std::uint64_t round = 0; round < 60; ++round) {
        const RandomProblem random = variedProblem(round);
        const RelaxedCells cells(random.problem);
        std::vector<std::vector<std::uint32_t>> kept;
        for (const SensorType& kind : random.problem.kinds) {
            kept.emplace_back();
            for (std::uint32_t i = 0; i < kind.candidates->size(); ++i)
                if ((i * 7 + round) % 3 == 0) kept.back().push_back(i);
        }
        std::vector<std::uint32_t> multipliers = cells.weights;
        for (std::size_t i = 0; i < multipliers.size(); ++i)
            multipliers[i] = static_cast<std::uint32_t>(multipliers[i] * (i % 5) / 5);
        const WeightSums before(multipliers);
        const ReducedProblem whole = wholeProblem(random.problem, cells);
        const ReducedProblem reduced = reduce(whole, kept, multipliers);
        ASSERT_LE(reduced.cells(), random.problem.cells());
        const WeightSums after(multipliers);
        for (std::size_t k = 0; k < kept.size(); ++k) {
            ASSERT_EQ(reduced.kinds[k].original, kept[k]);
            for (std::size_t i = 0; i < kept[k].size(); ++i)
                ASSERT_EQ(reduced.kinds[k].candidates->weigh(i, after),
                          random.problem.kinds[k].candidates->weigh(kept[k][i], before));
        }
    }
}

TEST(ReducedProblem, CellsThatTheSameSeeAreOne) {
    CandidateSet set(8);
    CellSet left(8), right(8), other(8);
    for (const std::size_t i : {0U, 1U, 2U, 5U, 6U}) left.set(i);
    for (const std::size_t i : {2U, 6U, 7U}) right.set(i);
    for (std::size_t i = 0; i < 8; ++i) other.set(i);
    for (const CellSet& seen : {left, right, other}) set.addSite(seen);
    Problem problem;
    problem.weights = {1, 2, 3, 4, 5, 6, 7, 8};
    problem.kinds = {{&set, 1, 1, 1}};
    RelaxedCells cells(problem);
    std::vector<std::uint32_t> multipliers = {1, 1, 1, 1, 1, 1, 1, 1};
    // Cells 0, 1, 5 of the left alone; 2, 6 of both; 7 of the right alone; the others are unseen.
    const ReducedProblem reduced = reduce(wholeProblem(problem, cells), {{0, 1}}, multipliers);
    EXPECT_EQ(multipliers, (std::vector<std::uint32_t>{3, 2, 1}));
    EXPECT_EQ(reduced.weights,
              (std::vector<std::uint32_t>{9 * cells.scale, 10 * cells.scale, 8 * cells.scale}));
}

}  // namespace branch_and_bound_test

}  // namespace ispace
