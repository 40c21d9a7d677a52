// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "base/number.h"

namespace ispace {
namespace cost_levels_test {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool isSame(double a, double b) { return !isCheaper(a, b) && !isCheaper(b, a); }

/// With a thousand candidates of each kind.
class CostLevelsTest : public testing::Test {
  protected:
    CostLevelsTest() : candidates_(1) {
        for (int i = 0; i < 1000; ++i) candidates_.addSite(CellSet(1));
    }
    std::vector<SensorType> kindsOf(const std::vector<double>& costs, int most) const {
        std::vector<SensorType> kinds;
        kinds.reserve(costs.size());
        for (const double cost : costs) kinds.push_back({&candidates_, most, cost, 1});
        return kinds;
    }

    CandidateSet candidates_;
};

/// Calls visit(cost) for all counts of each kind.
template <typename Visit>
void forEachSum(const Problem& problem, std::vector<Choice>& chosen, std::size_t kind,
                Visit visit) {
    if (kind == problem.kinds.size()) {
        visit(costOf(problem, chosen));
        return;
    }
    const std::size_t before = chosen.size();
    for (int n = 0; n <= problem.kinds[kind].most; ++n) {
        forEachSum(problem, chosen, kind + 1, visit);
        chosen.push_back({kind, 0});
    }
    chosen.resize(before);
}

TEST_F(CostLevelsTest, SumsOfDecimalsAreOneLevel) {
    const CostLevels levels(kindsOf({0.1, 0.2}, 3), 0.7);
    ASSERT_EQ(levels.size(), 8U);
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(normaliseCost(levels.at(i)), normaliseCost(0.1 * static_cast<double>(i)));
    EXPECT_EQ(levels.below(0.3), 2U);
    EXPECT_EQ(levels.below(0.1 + 0.2), 2U);
    EXPECT_EQ(levels.below(0.31), 3U);
    EXPECT_EQ(levels.below(9), 7U);
    EXPECT_EQ(levels.below(0.1), 0U);
    EXPECT_EQ(levels.below(0), 0U);
    EXPECT_EQ(normaliseCost(levels.above(2)), 0.3);
    EXPECT_EQ(levels.above(7), kInfinite);
}

TEST_F(CostLevelsTest, ManyOfEqualCostAreAllThere) {
    for (const double cost : {1.0, 0.1, 1.0 / 3, 1e6}) {
        const CostLevels levels(kindsOf({cost, cost, cost}, 1000), 2800 * cost);
        ASSERT_FALSE(levels.isEven());
        ASSERT_EQ(levels.size(), 2801U);
        for (std::size_t i = 0; i < levels.size(); ++i)
            ASSERT_TRUE(isSame(levels.at(i), static_cast<double>(i) * cost));
    }
}

TEST_F(CostLevelsTest, NoMoreOfAKindThanItHasCandidates) {
    EXPECT_EQ(CostLevels(kindsOf({1}, 5000), 5000).size(), 1001U);
    EXPECT_EQ(CostLevels(kindsOf({1}, -1), 5000).size(), 1U);
    EXPECT_EQ(CostLevels({}, 5000).size(), 1U);
}

TEST_F(CostLevelsTest, SmallCostsCountBesideLargeOnes) {
    const CostLevels levels(kindsOf({1e6, 0.001}, 1), 2e6);
    ASSERT_EQ(levels.size(), 4U);
    EXPECT_EQ(levels.at(1), 0.001);
    EXPECT_EQ(levels.at(2), 1e6);
    EXPECT_EQ(levels.at(3), 1000000.001);
    EXPECT_EQ(levels.below(1000000.001), 2U);
    EXPECT_EQ(levels.above(2), 1000000.001);
}

TEST_F(CostLevelsTest, EachSumIsBoughtByOneLevelAndNotByTheOneBefore) {
    std::mt19937_64 random(7);
    const double costs[] = {1, 0.1, 0.2, 0.7, 1.0 / 3, 2.5, 0.001, 1e6, 999'999.999, 1e-6};
    for (int round = 0; round < 300; ++round) {
        Problem problem;
        problem.kinds = kindsOf({costs[random() % 10], costs[random() % 10], costs[random() % 10]},
                                static_cast<int>(1 + random() % 6));
        double most = 0;
        for (const SensorType& kind : problem.kinds) most += kind.cost * kind.most;
        if (round % 2 == 0) most /= 2;
        const CostLevels levels(problem.kinds, most);
        ASSERT_FALSE(levels.isEven());
        std::vector<char> is_met(levels.size(), 0);
        std::vector<Choice> chosen;
        forEachSum(problem, chosen, 0, [&](double cost) {
            if (isCheaper(most, cost)) return;
            const std::size_t below = levels.below(cost);
            const std::size_t level = below + (cost > 0 ? 1 : 0);
            ASSERT_LT(level, levels.size()) << cost;
            is_met[level] = 1;
            problem.budget = levels.at(level);
            ASSERT_TRUE(isAffordable(problem, cost)) << cost;
            if (level == 0) return;
            problem.budget = levels.at(below);
            ASSERT_FALSE(isAffordable(problem, cost)) << cost;
            ASSERT_FALSE(isCheaper(cost, levels.above(below))) << cost;
        });
        ASSERT_EQ(std::count(is_met.begin(), is_met.end(), 0), 0) << round;
    }
}

TEST_F(CostLevelsTest, TooManySumsAreEvenStepsOfFewDigits) {
    const double most = 327.8252249999999;
    const CostLevels levels(kindsOf({1.2345, 1.41421, 1.73205}, 60), most);
    ASSERT_TRUE(levels.isEven());
    ASSERT_EQ(levels.size(), 4001U);
    EXPECT_EQ(levels.at(0), 0);
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const double even = most * static_cast<double>(i) / 4000;
        ASSERT_LE(levels.at(i), even);
        ASSERT_GT(levels.at(i), even - most * 1e-5);
        ASSERT_LE(formatDouble(levels.at(i)).size(), 7U);
        // Something may cost hardly more.
        ASSERT_EQ(levels.above(i), levels.at(i));
    }
    EXPECT_EQ(levels.at(4000), 327.825);
    EXPECT_EQ(levels.below(levels.at(4000)), 3999U);
    EXPECT_EQ(levels.below(most), 4000U);
}

}  // namespace cost_levels_test
}  // namespace ispace
