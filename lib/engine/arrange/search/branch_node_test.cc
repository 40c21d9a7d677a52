// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/branch_node.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "arrange/search/branch_and_bound.h"
#include "arrange/search/relaxation.h"
#include "support/test_problems.h"

namespace ispace {

namespace branch_node_test {

/// A node with all candidates of a problem of one kind.
BranchNode nodeOf(const Problem& problem, const Bound& bound) {
    const std::size_t count = problem.kinds[0].candidates->size();
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0U);
    std::vector<std::uint32_t> multipliers = bound.multipliers;
    BranchNode node;
    node.problem = std::make_shared<const ReducedProblem>(
        reduce(wholeProblem(problem, RelaxedCells(problem)), {all}, multipliers));
    node.multipliers = std::make_shared<const std::vector<std::uint32_t>>(std::move(multipliers));
    node.groups = {{0, static_cast<std::size_t>(problem.kinds[0].most),
                    std::make_shared<const std::vector<std::uint32_t>>(std::move(all))}};
    return node;
}

/// Splits it as branch() does, after some steps of the node's bound.
SplitNode splitOf(BranchNode& node, std::uint64_t cut) {
    SilentProgress progress;
    NodeRelaxation relaxed(node);
    MultiplierSearch search(relaxed.problem().weights, relaxed.start(node),
                            static_cast<double>(cut), kWarmPace);
    node.bound = relaxed.evaluate(search.trial());
    for (int trial = 0; trial < 20; ++trial) {
        search.report(static_cast<double>(relaxed.evaluate(search.trial())), relaxed.cover());
        relaxed.count(static_cast<float>(search.part()));
    }
    return splitNode(node, relaxed, search.best(), cut, progress);
}

TEST(SplitNode, NothingIsLost) {
    SilentProgress progress;
    int closed = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        RandomProblemOptions options;
        options.columns = 20;
        options.rows = 16;
        options.sites = 12;
        options.max_range = 7;
        options.most = 3;
        const RandomProblem random = randomProblem(seed, options);
        const Problem& problem = random.problem;
        const Solution nothing{{}, valueOf(problem, {})};
        const Bound bound = lagrangianBound(problem, {}, {.cut = 0, .rounds = 2}, progress);
        SearchResult known{nothing, bound.value};
        known = branchAndBound(problem, bound, known, 0, progress);
        ASSERT_EQ(known.best.value, known.bound);
        const RelaxedCells cells(problem);
        const std::uint64_t best = known.best.value * cells.scale;
        for (const std::uint64_t cut : {best / 2, best, best + best / 50, best + best / 20}) {
            BranchNode node = nodeOf(problem, bound);
            const SplitNode split = splitOf(node, cut);
            ASSERT_LE(split.closed, cut);
            std::uint64_t most = split.closed;
            for (const BranchNode& child : split.children) {
                ASSERT_GT(child.bound, cut);
                ASSERT_LE(child.bound, node.bound);
                most = std::max(most, child.bound);
            }
            ASSERT_GE(most, best) << seed;
            if (split.children.empty()) ++closed;
        }
    }
    EXPECT_GT(closed, 10);  // it is not for want of such cases
}

TEST(SplitNode, ChildrenShareOutTheGroup) {
    RandomProblemOptions options;
    options.sites = 10;
    options.most = 4;
    const RandomProblem random = randomProblem(3, options);
    SilentProgress progress;
    BranchNode node = nodeOf(
        random.problem, lagrangianBound(random.problem, {}, {.cut = 0, .rounds = 1}, progress));
    const SplitNode split = splitOf(node, 0);
    ASSERT_GE(split.children.size(), 2U);
    for (const BranchNode& child : split.children) {
        std::size_t count = 0, listed = 0;
        for (const BranchGroup& group : child.groups) {
            count += group.count;
            listed += group.list->size();
        }
        EXPECT_EQ(count, 4U);
        EXPECT_LE(listed, node.groups[0].list->size());
        EXPECT_GT(listed, 0U);
    }
}

}  // namespace branch_node_test

}  // namespace ispace
