// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/areas.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "base/random.h"
#include "solve/branch_and_bound.h"
#include "solve/test_problems.h"

namespace ispace {

namespace {

/// Six sensors, few enough candidates to try all sets.
RandomProblem sixSensors(std::uint64_t round) {
    RandomProblemOptions options;
    options.columns = 16;
    options.rows = 12;
    options.max_range = 5;
    options.kinds = round % 3 == 2 ? 2 : 1;
    options.sites = options.kinds == 2 ? 3 : 6;
    options.headings = 3;
    options.most = 6 / options.kinds;
    options.max_weight = round % 5 == 4 ? 9 : 1;
    options.required = round % 4 == 3 ? 2 : 1;
    options.max_achieved = round % 4 >= 2 ? 1 : 0;
    options.is_connected = round % 7 == 6;
    return randomProblem(500 + round, options);
}

/// A poor solution: any six.
Solution anySix(const Problem& problem, std::uint64_t seed) {
    Solution six;
    for (std::size_t k = 0; k < problem.kinds.size(); ++k) {
        const std::size_t size = problem.kinds[k].candidates->size();
        for (int n = 0; n < problem.kinds[k].most; ++n)
            six.chosen.push_back({k, (seed + 5 * static_cast<std::size_t>(n)) % size});
    }
    six.value = valueOf(problem, six.chosen);
    return six;
}

TEST(Areas, AreWhoseViewOverlapsMost) {
    CandidateSet candidates(6);
    for (const auto& cells : {std::vector<std::size_t>{0, 1, 2}, {3, 4}, {2, 3, 4}, {1, 4}, {5}}) {
        CellSet seen(6);
        for (const std::size_t cell : cells) seen.set(cell);
        candidates.addSite(seen);
    }
    Problem problem;
    problem.weights.assign(6, 1);
    problem.kinds = {{&candidates, 2}};
    const std::vector<Choice> near = {{0, 0}, {0, 1}};
    EXPECT_EQ(areasAbout(problem, near, {1, 1, 1, 1, 1, 1}), (Areas{{0, 1, 1, 0, 0}}));
    EXPECT_EQ(areasAbout(problem, near, {1, 1, 9, 1, 2, 1}), (Areas{{0, 1, 0, 1, 0}}));
}

/// A node with all candidates of a problem of one kind, and its relaxation after some steps.
struct WholeNode {
    BranchNode node;
    std::unique_ptr<NodeRelaxation> relaxed;

    explicit WholeNode(const Problem& problem) {
        std::vector<std::uint32_t> all(problem.kinds[0].candidates->size());
        std::iota(all.begin(), all.end(), 0U);
        const RelaxedCells cells(problem);
        std::vector<std::uint32_t> multipliers = cells.weights;
        node.problem = std::make_shared<const ReducedProblem>(
            reduce(wholeProblem(problem, cells), {all}, multipliers));
        node.multipliers = std::make_shared<const std::vector<std::uint32_t>>(multipliers);
        node.groups = {{0, static_cast<std::size_t>(problem.kinds[0].most),
                        std::make_shared<const std::vector<std::uint32_t>>(std::move(all))}};
        relaxed = std::make_unique<NodeRelaxation>(node);
        MultiplierSearch search(relaxed->problem().weights, multipliers, 0, kWarmPace);
        node.bound = relaxed->evaluate(search.trial());
        for (int trial = 0; trial < 20; ++trial) {
            search.report(static_cast<double>(relaxed->evaluate(search.trial())), relaxed->cover());
            relaxed->count(static_cast<float>(search.part()));
        }
    }
};

/// True if a node has this set: no more from a group than it counts, and none from elsewhere.
bool hasSet(const BranchNode& node, const std::vector<std::uint32_t>& set) {
    std::size_t found = 0;
    for (const BranchGroup& group : node.groups) {
        std::size_t own = 0;
        for (const std::uint32_t i : set)
            if (std::binary_search(group.list->begin(), group.list->end(), i)) ++own;
        if (own > group.count) return false;
        found += own;
    }
    return found == set.size();
}

TEST(Areas, EachFullSetIsInOneChild) {
    for (std::uint64_t round = 0; round < 40; ++round) {
        if (round % 3 == 2) continue;  // of two kinds
        const RandomProblem random = sixSensors(round);
        const Problem& problem = random.problem;
        const WholeNode whole(problem);
        const Areas areas = areasAbout(problem, anySix(problem, round).chosen, problem.weights);
        const std::vector<BranchNode> children = splitByAreas(whole.node, *whole.relaxed, areas);
        ASSERT_GE(children.size(), 2U) << round;
        const auto size = static_cast<std::uint32_t>(problem.kinds[0].candidates->size());
        for (std::uint32_t seed = 0; seed < 200; ++seed) {
            std::vector<std::uint32_t> all(size), set;
            std::iota(all.begin(), all.end(), 0U);
            for (std::uint32_t n = 0; n < 6; ++n) {
                const std::size_t at = mixedBits(seed * 64 + n) % all.size();
                set.push_back(all[at]);
                all.erase(all.begin() + static_cast<std::ptrdiff_t>(at));
            }
            const auto having =
                std::count_if(children.begin(), children.end(),
                              [&set](const BranchNode& child) { return hasSet(child, set); });
            ASSERT_EQ(having, 1) << round;
        }
        for (const BranchNode& child : children) ASSERT_EQ(child.bound, whole.node.bound);
    }
}

TEST(Areas, OneAreaIsNoSplit) {
    const RandomProblem random = sixSensors(0);
    const WholeNode whole(random.problem);
    EXPECT_TRUE(splitByAreas(whole.node, *whole.relaxed, {}).empty());
    const Areas one = areasAbout(random.problem, {{0, 3}}, random.problem.weights);
    EXPECT_TRUE(splitByAreas(whole.node, *whole.relaxed, one).empty());
}

SearchResult searchTree(const Problem& problem, const Solution& known, Progress& progress) {
    const Bound bound = lagrangianBound(problem, {}, {.cut = known.value, .rounds = 1}, progress);
    return branchAndBound(problem, bound, {known, bound.value}, 0, progress);
}

TEST(Areas, TreeEqualsBruteForce) {
    int branched = 0;
    for (std::uint64_t round = 0; round < 60; ++round) {
        const RandomProblem random = sixSensors(round);
        const std::uint64_t best = bestByBruteForce(random.problem).value;
        Solution known = anySix(random.problem, round);
        if (!isFeasible(random.problem, known.chosen)) known.value = 0;
        StopWhen progress([](const StopWhen&) { return false; });
        const SearchResult result = searchTree(random.problem, known, progress);
        ASSERT_EQ(result.best.value, best) << round;
        ASSERT_EQ(result.bound, best) << round;
        ASSERT_EQ(valueOf(random.problem, result.best.chosen), best) << round;
        ASSERT_TRUE(isFeasible(random.problem, result.best.chosen)) << round;
        if (progress.done > 10) ++branched;
    }
    EXPECT_GT(branched, 20);
}

TEST(Areas, TreeIsTheSameForAnyNumberOfThreads) {
    RandomProblemOptions options;
    options.columns = 40;
    options.rows = 30;
    options.sites = 60;
    options.headings = 4;
    options.most = 7;
    options.max_range = 8;
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
        const RandomProblem random = randomProblem(seed, options);
        const auto searched = [&](std::size_t threads) {
            const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                              threads);
            StopWhen progress([](const StopWhen& told) { return told.done >= 200; });
            return searchTree(random.problem, anySix(random.problem, seed), progress);
        };
        const SearchResult one = searched(1), four = searched(4);
        EXPECT_EQ(one.best.chosen, four.best.chosen) << seed;
        EXPECT_EQ(one.bound, four.bound) << seed;
    }
}

}  // namespace

}  // namespace ispace
