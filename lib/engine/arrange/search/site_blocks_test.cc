// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/site_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/test_problems.h"

namespace ispace {
namespace site_blocks_test {

std::uint32_t mostAt(const CandidateSet& candidates, std::size_t site,
                     const std::vector<std::uint32_t>& gains) {
    std::vector<std::uint32_t> values(candidates.firstOf(site + 1) - candidates.firstOf(site));
    candidates.weighSite(site, WeightSums(gains), values);
    return *std::max_element(values.begin(), values.end());
}

/// Bounds of random gains; returns the sum of the bounds over that of the largest gains.
double checkBounds(const Problem& problem, std::uint64_t seed) {
    test_problems::Random random(seed);
    const CandidateSet& candidates = *problem.kinds[0].candidates;
    const SiteBlocks blocks(problem, candidates);
    double sum = 0, most = 0;
    for (int round = 0; round < 10; ++round) {
        std::vector<std::uint32_t> gains = problem.weights;
        for (std::uint32_t& gain : gains)
            if (random() % 10 < static_cast<std::uint64_t>(round)) gain = 0;
        std::vector<std::uint32_t> bounds(candidates.sites());
        blocks.bound(gains, bounds);
        for (std::size_t site = 0; site < bounds.size(); ++site) {
            const std::uint32_t value = mostAt(candidates, site, gains);
            EXPECT_GE(bounds[site], value) << "seed " << seed << ", site " << site;
            sum += bounds[site];
            most += value;
        }
    }
    return most > 0 ? sum / most : 1;
}

TEST(SiteBlocks, BoundAllCandidatesOfASite) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        RandomProblemOptions options;
        options.max_weight = seed % 2 == 0 ? 1 : 9;
        RandomProblem made = randomProblem(seed, options);
        checkBounds(made.problem, seed);
        made.problem.blocks.resize(made.problem.cells());
        for (std::size_t i = 0; i < made.problem.cells(); ++i)
            made.problem.blocks[i] = static_cast<std::uint32_t>(i % 7);
        checkBounds(made.problem, seed);
        // A block for each cell bounds a single view by its weight.
        for (std::size_t i = 0; i < made.problem.cells(); ++i)
            made.problem.blocks[i] = static_cast<std::uint32_t>(i);
        checkBounds(made.problem, seed);
    }
}

TEST(SiteBlocks, RoundUpLargeWeights) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        RandomProblem made = randomProblem(seed, {});
        std::uint64_t sum = made.problem.totalWeight();
        for (std::uint32_t& weight : made.problem.weights)
            weight *= static_cast<std::uint32_t>(4'000'000'000U / std::max<std::uint64_t>(1, sum));
        checkBounds(made.problem, seed);
    }
}

TEST(SiteBlocks, AreExactForBlocksThatAreSeenWhole) {
    CandidateSet candidates(64);
    for (std::size_t site = 0; site < 4; ++site) {
        CellSet seen(64);
        for (std::size_t cell = 0; cell < 16 * (site + 1); ++cell) seen.set(cell);
        candidates.addSite(seen);
    }
    Problem problem;
    problem.weights.assign(64, 3);
    problem.kinds = {{&candidates}};
    std::vector<std::uint32_t> bounds(4), gains = problem.weights;
    const SiteBlocks blocks(problem, candidates);
    blocks.bound(gains, bounds);
    EXPECT_EQ(bounds, (std::vector<std::uint32_t>{48, 96, 144, 192}));
    std::fill(gains.begin(), gains.begin() + 20, 0U);  // of the second block, 12 are left
    blocks.bound(gains, bounds);
    EXPECT_EQ(bounds, (std::vector<std::uint32_t>{0, 36, 84, 132}));
}

}  // namespace site_blocks_test
}  // namespace ispace
