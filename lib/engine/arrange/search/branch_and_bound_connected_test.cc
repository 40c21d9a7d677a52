// SPDX-License-Identifier: GPL-3.0-or-later
// Tests trees over sensors that require connected coverage: fewer sensors may be feasible where the
// full number is not.
#include <gtest/gtest.h>

#include "arrange/search/branch_and_bound.h"
#include "arrange/search/relaxation.h"
#include "support/test_problems.h"

namespace ispace {
namespace branch_and_bound_connected_test {

SearchResult searchTree(const Problem& problem) {
    SilentProgress progress;
    SearchResult known;
    known.best = {{}, valueOf(problem, {})};
    const Bound bound =
        lagrangianBound(problem, {}, {.cut = known.best.value, .rounds = 1}, progress);
    known.bound = bound.value;
    return branchAndBound(problem, bound, known, 0, progress);
}

/// A row of six that see a cell of the next one each, and one apart, which sees more.
struct Row {
    CandidateSet candidates = CandidateSet(20);
    Problem problem;

    Row() {
        for (std::size_t i = 0; i < 6; ++i) add({2 * i, 2 * i + 1, 2 * i + 2});
        add({16, 17, 18, 19});
        problem.weights.assign(20, 1);
        problem.kinds = {{&candidates, 7, 1, 1}};
        problem.is_connected = true;
    }
    void add(const std::vector<std::size_t>& cells) {
        CellSet seen(20);
        for (const std::size_t cell : cells) seen.set(cell);
        candidates.addSite(seen);
    }
};

TEST(ConnectedTree, TakesFewerWhereNotAllHangTogether) {
    const Row row;
    const SearchResult result = searchTree(row.problem);
    EXPECT_EQ(result.best.value, 13U);
    EXPECT_EQ(result.bound, 13U);
    EXPECT_EQ(result.best.chosen.size(), 6U);
}

TEST(ConnectedTree, MinimumCostReachesWhatCanBeReached) {
    const Row row;
    SilentProgress progress;
    SearchOptions options;
    options.optimizer = Optimizer::Exact;
    for (std::uint64_t wanted = 1; wanted <= 13; ++wanted) {
        const MinimumCostCover cover = minimumCostCover(row.problem, wanted, options, progress);
        ASSERT_TRUE(cover.is_reached) << wanted;
        // One sees 4, one of a chain 2 more than those before.
        const double cost = wanted <= 4 ? 1 : static_cast<double>(wanted / 2);
        EXPECT_EQ(cover.cost, cost) << wanted;
        EXPECT_EQ(cover.cost_bound, cost) << wanted;
    }
    EXPECT_FALSE(minimumCostCover(row.problem, 14, options, progress).is_reached);
}

TEST(ConnectedTree, ManySensorsEqualBruteForce) {
    RandomProblemOptions options;
    options.columns = 16;
    options.rows = 14;
    options.headings = 1;
    options.max_weight = 5;
    options.is_connected = true;
    std::size_t partial = 0;  // where the best is not as many as may be
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
        options.sites = 7 + static_cast<int>(seed % 5);
        options.most = 7 + static_cast<int>(seed % 3);
        options.max_range = 2 + static_cast<int>(seed / 3 % 3);
        options.has_standing = seed % 7 == 6;
        const RandomProblem random = randomProblem(seed, options);
        const Solution best = bestByBruteForce(random.problem);
        const SearchResult result = searchTree(random.problem);
        ASSERT_EQ(result.best.value, best.value) << seed;
        ASSERT_EQ(result.bound, best.value) << seed;
        ASSERT_TRUE(isFeasible(random.problem, result.best.chosen)) << seed;
        if (static_cast<int>(best.chosen.size()) < std::min(options.sites, options.most)) ++partial;
    }
    EXPECT_GT(partial, 60U);
}

TEST(ConnectedTree, ManySensorsOfTwoKindsEqualBruteForce) {
    RandomProblemOptions options;
    options.kinds = 2;
    options.sites = 5;
    options.most = 4;
    options.headings = 1;
    options.max_range = 3;
    options.is_connected = true;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        options.has_costs = seed % 3 == 2;
        const RandomProblem random = randomProblem(seed, options);
        const std::uint64_t best = bestByBruteForce(random.problem).value;
        const SearchResult result = searchTree(random.problem);
        ASSERT_EQ(result.best.value, best) << seed;
        ASSERT_EQ(result.bound, best) << seed;
    }
}

}  // namespace branch_and_bound_connected_test
}  // namespace ispace
