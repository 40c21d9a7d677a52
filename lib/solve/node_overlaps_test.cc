// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/node_overlaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "solve/lagrange.h"
#include "solve/relaxation.h"
#include "solve/test_problems.h"

namespace ispace {

namespace {

using Set = std::vector<std::uint32_t>;

/// A node that chooses one candidate from each of three lists.
struct Case {
    RandomProblem random;
    BranchNode node;
    std::vector<std::pair<std::uint64_t, Set>> sets;  ///< value and candidates of every choice
    std::uint64_t best = 0;

    explicit Case(std::uint64_t seed) {
        RandomProblemOptions options;
        options.columns = 20;
        options.rows = 14;
        options.sites = 15;
        options.max_range = 8;
        options.max_weight = seed % 3 == 0 ? 9 : 1;
        options.max_achieved = seed % 4 == 0 ? 1 : 0;
        random = randomProblem(seed, options);
        const Problem& problem = random.problem;
        SilentProgress progress;
        const Bound bound =
            lagrangianBound(problem, placeGreedily(problem, progress).chosen, {}, progress);
        Set all(problem.kinds[0].candidates->size());
        for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
        std::vector<std::uint32_t> multipliers = bound.multipliers;
        node.problem = std::make_shared<const ReducedProblem>(
            reduce(wholeProblem(problem, RelaxedCells(problem)), {all}, multipliers));
        node.multipliers = std::make_shared<const std::vector<std::uint32_t>>(multipliers);
        const auto third = static_cast<std::ptrdiff_t>(all.size() / 3);
        for (int i = 0; i < 3; ++i)
            node.groups.push_back(
                {0, 1,
                 std::make_shared<const Set>(all.begin() + i * third,
                                             i == 2 ? all.end() : all.begin() + (i + 1) * third)});
        for (const std::uint32_t a : *node.groups[0].list)
            for (const std::uint32_t b : *node.groups[1].list)
                for (const std::uint32_t c : *node.groups[2].list) add({a, b, c});
    }

  private:
    void add(const Set& chosen) {
        const ReducedProblem& problem = *node.problem;
        std::vector<char> is_seen(problem.cells(), 0);
        for (const std::uint32_t i : chosen)
            problem.kinds[0].candidates->forEachRun(i, [&is_seen](const CellRun& run) {
                std::fill(is_seen.begin() + run.first, is_seen.begin() + run.end, 1);
            });
        std::uint64_t value = problem.settled;
        for (std::size_t i = 0; i < is_seen.size(); ++i)
            if (is_seen[i] != 0) value += problem.weights[i];
        sets.emplace_back(value, chosen);
        best = std::max(best, value);
    }
};

/// Its relaxation after some trials, and the multipliers of the best.
NodeRelaxation relaxationOf(const Case& one, std::vector<std::uint32_t>& multipliers,
                            std::uint64_t& bound) {
    NodeRelaxation relaxed(one.node);
    MultiplierSearch search(relaxed.problem().weights, relaxed.start(one.node),
                            static_cast<double>(one.best), kWarmPace);
    for (int trial = 0; trial < 60; ++trial) {
        search.report(static_cast<double>(relaxed.evaluate(search.trial())), relaxed.cover());
        relaxed.count(static_cast<float>(search.part()));
    }
    multipliers = search.best();
    bound = relaxed.evaluate(multipliers);
    return relaxed;
}

TEST(NodeOverlaps, BoundEveryChoiceAndRuleOutNoneThatIsBetter) {
    int lower = 0, open = 0, dropped = 0;
    for (std::uint64_t seed = 0; seed < 80; ++seed) {
        const Case one(seed);
        std::vector<std::uint32_t> start;
        std::uint64_t plain = 0;
        const NodeRelaxation relaxed = relaxationOf(one, start, plain);
        ASSERT_TRUE(NodeOverlaps::isFor(relaxed));
        for (const std::uint64_t cut : {one.best - 1, one.best - one.best / 50, one.best / 2}) {
            NodeOverlaps overlaps(relaxed, start);
            MultiplierSearch search(relaxed.problem().weights, start,
                                    static_cast<double>(one.best));
            std::uint64_t least = plain;
            for (int round = 0; round < 4; ++round) {
                for (int trial = 0; trial < 8; ++trial)
                    search.report(static_cast<double>(overlaps.evaluateWorking(search.trial())),
                                  overlaps.cover());
                overlaps.addWorthiest(search.best());
                const std::vector<std::uint32_t> multipliers = search.best();
                const std::uint64_t bound = overlaps.evaluate(multipliers, cut, SilentProgress());
                ASSERT_GE(bound, one.best) << seed;
                least = std::min(least, bound);
                search.restart(static_cast<double>(bound), overlaps.cover());
                overlaps.widen();
                overlaps.ruleOut(cut, multipliers);
                ASSERT_LE(overlaps.ruledOut(), cut);
                ASSERT_FALSE(overlaps.isClosed());
                const std::vector<Set> lists = overlaps.lists();
                for (const auto& [value, chosen] : one.sets)
                    for (std::size_t g = 0; value > cut && g < chosen.size(); ++g)
                        ASSERT_TRUE(std::binary_search(lists[g].begin(), lists[g].end(), chosen[g]))
                            << seed;
                for (std::size_t g = 0; g < lists.size(); ++g)
                    if (lists[g].size() < one.node.groups[g].list->size()) ++dropped;
            }
            if (plain > one.best) ++open;
            if (least < plain) ++lower;
        }
    }
    EXPECT_GT(open, 60);
    EXPECT_GT(lower, open / 3);
    EXPECT_GT(dropped, 100);
}

TEST(NodeOverlaps, CloseWhatIsNotBetter) {
    int closed = 0;
    for (std::uint64_t seed = 100; seed < 140; ++seed) {
        const Case one(seed);
        std::vector<std::uint32_t> start;
        std::uint64_t plain = 0;
        const NodeRelaxation relaxed = relaxationOf(one, start, plain);
        NodeOverlaps overlaps(relaxed, start);
        overlaps.evaluate(start, plain + 1, SilentProgress());
        overlaps.ruleOut(plain + 1, start);
        if (overlaps.isClosed()) ++closed;
        ASSERT_LE(overlaps.ruledOut(), plain + 1);
        ASSERT_GE(overlaps.ruledOut(), one.best);
    }
    EXPECT_EQ(closed, 40);
}

/// Nodes that it takes to search a case for what is better than `cut`, and the best of it.
int nodesOf(const Case& one, std::uint64_t cut, OverlapTrust trust, std::uint64_t& best) {
    const SilentProgress progress;
    const RelaxedCells cells(one.random.problem);
    std::vector<BranchNode> open = {one.node};
    open[0].bound = std::numeric_limits<std::uint32_t>::max();
    int nodes = 0;
    best = cut;
    while (!open.empty()) {
        const BranchNode node = std::move(open.back());
        open.pop_back();
        ++nodes;
        BranchResult result = branch(one.random.problem, node, {}, best, trust, progress);
        EXPECT_LE(result.closed, best);
        trust.learn(result);
        if (!result.found.empty())
            best = std::max(best, valueOf(one.random.problem, result.found) * cells.scale);
        for (BranchNode& child : result.children) open.push_back(std::move(child));
    }
    return nodes;
}

TEST(NodeOverlaps, LeaveFewerNodesAndTheSameBest) {
    int with = 0, without = 0;
    for (std::uint64_t seed = 200; seed < 240; ++seed) {
        const Case one(seed);
        for (const std::uint64_t cut : {one.best - 1, one.best - one.best / 30, one.best}) {
            std::uint64_t best = 0, plain = 0;
            with += nodesOf(one, cut, OverlapTrust(), best);
            without += nodesOf(one, cut, OverlapTrust(0), plain);
            ASSERT_EQ(best, one.best) << seed;
            ASSERT_EQ(plain, one.best) << seed;
        }
    }
    EXPECT_LT(with, without);
}

TEST(OverlapTrust, FallsByFailuresAndRisesAgain) {
    OverlapTrust trust;
    BranchResult none, failed, closed;
    failed.overlaps_tried = 1000;
    failed.children.resize(2);
    closed.overlaps_tried = 800;
    trust.learn(none);
    trust.learn(closed);
    EXPECT_GT(trust.most(), std::uint64_t{1} << 60U);
    trust.learn(failed);
    EXPECT_EQ(trust.most(), 850U);
    trust.learn(closed);
    EXPECT_EQ(trust.most(), 920U);
    closed.overlaps_tried = 100;  // says nothing of nodes so far above the cut
    trust.learn(closed);
    EXPECT_EQ(trust.most(), 920U);
}

TEST(NodeOverlaps, AreForOneSensorOfEachGroup) {
    Case one(1);
    EXPECT_TRUE(NodeOverlaps::isFor(NodeRelaxation(one.node)));
    one.node.groups[0].count = 2;
    EXPECT_FALSE(NodeOverlaps::isFor(NodeRelaxation(one.node)));
    one.node.groups.resize(1);
    EXPECT_FALSE(NodeOverlaps::isFor(NodeRelaxation(one.node)));
}

}  // namespace

}  // namespace ispace
