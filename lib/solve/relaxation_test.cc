// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace ispace {

namespace {

using Counts = std::vector<std::size_t>;

/// Six candidates that see nothing.
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

}  // namespace

}  // namespace ispace
