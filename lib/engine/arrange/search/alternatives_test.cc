// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/alternatives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "support/test_problems.h"

namespace ispace {
namespace alternatives_test {

/// Finds the largest value of a feasible solution that differs from all of these.
std::uint64_t bestThatDiffers(const Problem& problem, const std::vector<Solution>& others,
                              const NearChoices& are_near) {
    std::vector<Choice> all;
    for (std::size_t kind = 0; kind < problem.kinds.size(); ++kind)
        for (std::size_t i = 0; i < problem.kinds[kind].candidates->size(); ++i)
            all.push_back({kind, i});
    std::uint64_t best = 0;
    Solution now;
    const std::function<void(std::size_t)> extend = [&](std::size_t from) {
        if (!isWithinLimits(problem, now.chosen)) return;
        if (!now.chosen.empty() && isFeasible(problem, now.chosen) &&
            std::all_of(others.begin(), others.end(),
                        [&](const Solution& other) { return differs(now, other, are_near); }))
            best = std::max(best, valueOf(problem, now.chosen));
        for (std::size_t i = from; i < all.size(); ++i) {
            now.chosen.push_back(all[i]);
            extend(i + 1);
            now.chosen.pop_back();
        }
    };
    extend(0);
    return best;
}

TEST(Alternatives, AreTheBestThatDiffer) {
    SilentProgress progress;
    SearchOptions options;
    options.optimizer = Optimizer::Exact;
    options.swap.starts = 3;
    for (std::uint64_t round = 0; round < 20; ++round) {
        RandomProblemOptions varied;
        varied.sites = 5;
        varied.most = 1 + static_cast<int>(round % 3);
        varied.kinds = 1 + static_cast<int>(round % 2);
        if (varied.kinds == 2) varied.most = 1;
        varied.max_weight = 1 + static_cast<int>(round % 4);
        const RandomProblem random = randomProblem(round, varied);
        const Problem& problem = random.problem;
        const NearChoices same_site = [&](const Choice& a, const Choice& b) {
            const CandidateSet& set = *problem.kinds[a.kind].candidates;
            return a.kind == b.kind && set.siteOf(a.candidate) == set.siteOf(b.candidate);
        };
        const Solution best = search(problem, options, progress).best;
        const auto found = alternativesTo(problem, best, same_site, 3, options, progress);
        ASSERT_FALSE(found.empty()) << round;
        std::vector<Solution> before = {best};
        for (const Solution& one : found) {
            ASSERT_EQ(one.value, valueOf(problem, one.chosen)) << round;
            ASSERT_TRUE(isFeasible(problem, one.chosen)) << round;
            for (const Solution& other : before)
                ASSERT_TRUE(differs(one, other, same_site)) << round;
            ASSERT_EQ(one.value, bestThatDiffers(problem, before, same_site)) << round;
            before.push_back(one);
        }
    }
}

TEST(Alternatives, EndWhereAllSolutionsAreNear) {
    const RandomProblem random = randomProblem(1, RandomProblemOptions());
    SilentProgress progress;
    const Solution best = search(random.problem, {}, progress).best;
    const NearChoices always = [](const Choice&, const Choice&) { return true; };
    EXPECT_TRUE(alternativesTo(random.problem, best, always, 3, {}, progress).empty());
    EXPECT_TRUE(alternativesTo(random.problem, {}, always, 3, {}, progress).empty());
}

}  // namespace alternatives_test
}  // namespace ispace
