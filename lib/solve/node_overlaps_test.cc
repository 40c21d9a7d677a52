// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/node_overlaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

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
    /// By group and place in its list: the value of the best choice with this candidate.
    std::vector<std::vector<std::uint64_t>> most;
    std::uint64_t best = 0;

    /// \param sites of which three candidates each are listed, on average
    explicit Case(std::uint64_t seed, int sites = 15, int max_range = 8) {
        RandomProblemOptions options;
        options.columns = 20;
        options.rows = 14;
        options.sites = sites;
        options.max_range = max_range;
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
        findBest();
    }

  private:
    using Weights = std::vector<std::uint32_t>;
    /// What a candidate sees, and what weighs nothing afterwards.
    std::uint64_t take(std::uint32_t candidate, Weights& weights) const {
        std::uint64_t sum = 0;
        node.problem->kinds[0].candidates->forEachRun(candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i) sum += std::exchange(weights[i], 0);
        });
        return sum;
    }
    /// Of every choice.
    void findBest() {
        std::vector<std::vector<CellRun>> runs;  // of the last group's candidates
        for (const std::uint32_t c : *node.groups[2].list)
            node.problem->kinds[0].candidates->forEachRun(
                c, [&own = runs.emplace_back()](const CellRun& run) { own.push_back(run); });
        for (const BranchGroup& group : node.groups) most.emplace_back(group.list->size(), 0);
        std::vector<std::uint64_t> sums(node.problem->cells() + 1, 0);
        for (std::size_t a = 0; a < most[0].size(); ++a) {
            Weights without_a = node.problem->weights;
            const std::uint64_t value =
                node.problem->settled + take((*node.groups[0].list)[a], without_a);
            for (std::size_t b = 0; b < most[1].size(); ++b) {
                Weights without_both = without_a;
                const std::uint64_t both = value + take((*node.groups[1].list)[b], without_both);
                std::partial_sum(without_both.begin(), without_both.end(), sums.begin() + 1);
                for (std::size_t c = 0; c < runs.size(); ++c) {
                    std::uint64_t all = both;
                    for (const CellRun& run : runs[c]) all += sums[run.end] - sums[run.first];
                    for (std::uint64_t* const known :
                         {&most[0][a], &most[1][b], &most[2][c], &best})
                        *known = std::max(*known, all);
                }
            }
        }
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

/// Fails for each candidate that was ruled out although it is in a better choice.
/// \return how many were ruled out
int lookAtDropped(const Case& one, const NodeOverlaps& overlaps) {
    int dropped = 0;
    const std::vector<Set> lists = overlaps.lists();
    for (std::size_t g = 0; g < lists.size(); ++g) {
        const Set& all = *one.node.groups[g].list;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (std::binary_search(lists[g].begin(), lists[g].end(), all[i])) continue;
            EXPECT_LE(one.most[g][i], overlaps.ruledOut());
            ++dropped;
        }
    }
    return dropped;
}

/// What came of several cases and cuts.
struct Findings {
    int open = 0, lower = 0, dropped = 0;
};

/// Bounds that are no bounds, and candidates that were dropped wrongly, fail.
void lookAt(const Case& one, std::uint64_t seed, int trials, Findings& findings) {
    std::vector<std::uint32_t> start;
    std::uint64_t plain = 0;
    const NodeRelaxation relaxed = relaxationOf(one, start, plain);
    ASSERT_TRUE(NodeOverlaps::isFor(relaxed));
    for (const std::uint64_t cut : {one.best - 1, one.best - one.best / 50, one.best / 2}) {
        NodeOverlaps overlaps(relaxed, start);
        MultiplierSearch search(relaxed.problem().weights, start, static_cast<double>(one.best));
        std::uint64_t least = plain;
        for (int round = 0; round < 4; ++round) {
            for (int trial = 0; trial < trials; ++trial)
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
            findings.dropped += lookAtDropped(one, overlaps);
        }
        if (plain > one.best) ++findings.open;
        if (least < plain) ++findings.lower;
    }
}

TEST(NodeOverlaps, BoundEveryChoiceAndRuleOutNoneThatIsBetter) {
    Findings findings;
    for (std::uint64_t seed = 0; seed < 80; ++seed) lookAt(Case(seed), seed, 8, findings);
    EXPECT_GT(findings.open, 60);
    EXPECT_GT(findings.lower, findings.open / 3);
    EXPECT_GT(findings.dropped, 1000);
}

/// Twice as many candidates as are looked at to begin with, and those are the first ones: others
/// have the highest worth.
TEST(NodeOverlaps, BoundEveryChoiceOfThoseNotLookedAt) {
    int dropped = 0;
    for (std::uint64_t seed = 300; seed < 324; ++seed) {
        const Case one(seed, 120, 5);
        std::vector<std::uint32_t> multipliers;
        std::uint64_t plain = 0;
        relaxationOf(one, multipliers, plain);
        const NodeRelaxation relaxed(one.node);
        const std::vector<std::uint32_t> none(multipliers.size(), 0);
        for (const std::uint64_t cut :
             {one.best - 1, one.best, (one.best + plain) / 2, one.best - one.best / 50, plain}) {
            NodeOverlaps overlaps(relaxed, none);
            const std::uint64_t bound = overlaps.evaluate(multipliers, cut, SilentProgress());
            ASSERT_GE(bound, one.best) << seed;
            overlaps.ruleOut(cut, multipliers);
            dropped += lookAtDropped(one, overlaps);
            if (!overlaps.isClosed()) {
                EXPECT_LE(overlaps.evaluateWorking(multipliers), bound);
            }
        }
    }
    EXPECT_GT(dropped, 1000);
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
