// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "support/test_problems.h"

namespace ispace {

namespace problem_test {

using Cells = std::vector<std::size_t>;

/// Candidates that see these cells.
CandidateSet candidatesOf(std::size_t cells, const std::vector<Cells>& seen) {
    CandidateSet candidates(cells);
    for (const Cells& of : seen) {
        CellSet set(cells);
        for (const std::size_t cell : of) set.set(cell);
        candidates.addSite(set);
    }
    return candidates;
}

/// The definition, cell by cell.
std::uint64_t slowValueOf(const Problem& problem, const std::vector<Choice>& chosen) {
    std::uint64_t value = 0;
    for (std::size_t cell = 0; cell < problem.cells(); ++cell) {
        int multiplicities = problem.achieved.empty() ? 0 : problem.achieved[cell];
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const SensorType& kind = problem.kinds[chosen[i].kind];
            const bool is_repeated =
                std::find(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(i),
                          chosen[i]) != chosen.begin() + static_cast<std::ptrdiff_t>(i);
            if (!is_repeated && kind.candidates->cellsOf(chosen[i].candidate).test(cell))
                multiplicities += kind.multiplicity;
        }
        if (multiplicities >= problem.required) value += problem.weights[cell];
    }
    return value;
}

std::vector<Choice> randomChoices(test_problems::Random& random, const Problem& problem) {
    std::vector<Choice> chosen;
    for (std::size_t kind = 0; kind < problem.kinds.size(); ++kind)
        for (int i = 0; i < problem.kinds[kind].most; ++i)
            if (random() % 3 != 0)
                chosen.push_back({kind, random() % problem.kinds[kind].candidates->size()});
    return chosen;
}

TEST(Problem, ValueIsTheWeightOfTheUnion) {
    const CandidateSet candidates = candidatesOf(6, {{0, 1, 2}, {2, 3}, {}});
    Problem problem;
    problem.weights = {1, 2, 4, 8, 16, 32};
    problem.kinds = {{&candidates, 2}};
    EXPECT_EQ(problem.totalWeight(), 63U);
    EXPECT_EQ(valueOf(problem, {}), 0U);
    EXPECT_EQ(valueOf(problem, {{0, 0}}), 7U);
    EXPECT_EQ(valueOf(problem, {{0, 0}, {0, 1}}), 15U);
    EXPECT_EQ(valueOf(problem, {{0, 2}}), 0U);
    problem.achieved = {0, 0, 0, 0, 1, 0};
    EXPECT_EQ(valueOf(problem, {{0, 1}}), 28U);
}

TEST(Problem, SharesAddUpToTheDemandAndRepeatedChoicesCountOnce) {
    const CandidateSet narrow = candidatesOf(4, {{0, 1}, {1, 2}}), wide = candidatesOf(4, {{2, 3}});
    Problem problem;
    problem.weights = {1, 1, 1, 1};
    problem.required = 2;
    problem.kinds = {{&narrow, 2, 1, 1}, {&wide, 1, 1, 2}};
    EXPECT_EQ(valueOf(problem, {{0, 0}}), 0U);
    EXPECT_EQ(valueOf(problem, {{0, 0}, {0, 0}}), 0U);
    EXPECT_EQ(valueOf(problem, {{0, 0}, {0, 1}}), 1U);
    EXPECT_EQ(valueOf(problem, {{0, 0}, {1, 0}}), 2U);
    problem.achieved = {1, 0, 0, 0};
    EXPECT_EQ(valueOf(problem, {{0, 0}}), 1U);
}

TEST(Problem, ValueIsTheDefinitionOnRandomProblems) {
    RandomProblemOptions options;
    options.kinds = 2;
    options.max_weight = 9;
    options.required = 3;
    options.max_achieved = 3;
    options.multiplicities = {1, 2};
    test_problems::Random random(3);
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        const auto chosen = randomChoices(random, made.problem);
        EXPECT_EQ(valueOf(made.problem, chosen), slowValueOf(made.problem, chosen)) << seed;
    }
}

TEST(Problem, RemovingASensorNeverRaisesTheValue) {
    RandomProblemOptions options;
    options.kinds = 2;
    options.required = 2;
    options.multiplicities = {1, 2};
    test_problems::Random random(4);
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        auto chosen = randomChoices(random, made.problem);
        for (std::uint64_t value = valueOf(made.problem, chosen); !chosen.empty();) {
            chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(random() % chosen.size()));
            const std::uint64_t less = valueOf(made.problem, chosen);
            EXPECT_LE(less, value) << seed;
            value = less;
        }
    }
}

TEST(Problem, FeasibleIsWithinMostAndBudget) {
    const CandidateSet candidates = candidatesOf(2, {{0}, {1}});
    Problem problem;
    problem.weights = {1, 1};
    problem.kinds = {{&candidates, 2, 0.1, 1}, {&candidates, 1, 0.2, 1}};
    EXPECT_TRUE(isFeasible(problem, {{0, 0}, {0, 1}, {1, 0}}));
    EXPECT_FALSE(isFeasible(problem, {{1, 0}, {1, 1}}));
    problem.budget = 0.3;
    EXPECT_TRUE(isFeasible(problem, {{0, 0}, {1, 0}}));  // 0.1 + 0.2 is more than 0.3 in doubles
    EXPECT_FALSE(isFeasible(problem, {{0, 0}, {0, 1}, {1, 0}}));
    EXPECT_DOUBLE_EQ(costOf(problem, {{0, 0}, {0, 0}, {1, 0}}), 0.4);
    problem.budget = 0;
    EXPECT_TRUE(isFeasible(problem, {}));
    EXPECT_FALSE(isFeasible(problem, {{0, 0}}));
}

TEST(Problem, SmallCostsCountBesideLargeOnes) {
    const CandidateSet candidates = candidatesOf(2, {{0}, {1}});
    Problem problem;
    problem.weights = {1, 1};
    problem.kinds = {{&candidates, 1000, 1e6, 1}, {&candidates, 1000, 0.001, 1}};
    problem.budget = 1e6;
    EXPECT_TRUE(isFeasible(problem, {{0, 0}}));
    EXPECT_FALSE(isFeasible(problem, {{0, 0}, {1, 0}}));
    problem.budget = 1e9;
    std::vector<Choice> chosen(1000, {0, 0});
    EXPECT_TRUE(isFeasible(problem, chosen));
    chosen.push_back({1, 0});
    EXPECT_FALSE(isFeasible(problem, chosen));
    EXPECT_EQ(normaliseCost(costOf(problem, chosen)), 1e9 + 0.001);
}

TEST(Problem, CostsOfManyAreTheDecimalSumInAnyOrder) {
    test_problems::Random random(5);
    const CandidateSet candidates = candidatesOf(1, {{0}});
    Problem problem;
    problem.kinds = {{&candidates, 9, 0.1, 1}, {&candidates, 9, 0.7, 1}, {&candidates, 9, 1e6, 1}};
    for (int round = 0; round < 100; ++round) {
        std::vector<Choice> chosen;
        std::uint64_t tenths = 0;
        for (std::uint64_t n = random() % 1000; n > 0; --n) {
            chosen.push_back({random() % 3, 0});
            tenths += std::vector<std::uint64_t>{1, 7, 10'000'000}[chosen.back().kind];
        }
        const double cost = costOf(problem, chosen);
        EXPECT_EQ(normaliseCost(cost), static_cast<double>(tenths) / 10);
        std::reverse(chosen.begin(), chosen.end());
        EXPECT_EQ(costOf(problem, chosen), cost);
        problem.budget = static_cast<double>(tenths) / 10;
        EXPECT_TRUE(isAffordable(problem, cost));
        problem.budget = (static_cast<double>(tenths) - 1) / 10;
        EXPECT_FALSE(isAffordable(problem, cost));
    }
}

TEST(Problem, CheaperIsBelowByMoreThanRounding) {
    EXPECT_FALSE(isCheaper(0.3, 0.1 + 0.2));
    EXPECT_FALSE(isCheaper(0.1 + 0.2, 0.3));
    EXPECT_FALSE(isCheaper(0, 0));
    EXPECT_TRUE(isCheaper(0, 1e-9));
    EXPECT_TRUE(isCheaper(1e9, 1e9 + 0.001));
    EXPECT_FALSE(isCheaper(1e9 + 0.001, 1e9));
    EXPECT_TRUE(isCheaper(3e-9, 4e-9));
}

TEST(Problem, ABudgetBuysSoMany) {
    EXPECT_EQ(affordableCount(0.3, 0, 0.1, 9), 3U);
    EXPECT_EQ(affordableCount(0.3, 0.2, 0.1, 9), 1U);
    EXPECT_EQ(affordableCount(0.3, 0.1 + 0.2, 0.1, 9), 0U);
    EXPECT_EQ(affordableCount(0.3, 0.4, 0.1, 9), 0U);
    EXPECT_EQ(affordableCount(0.3, 0, 0.1, 2), 2U);
    EXPECT_EQ(affordableCount(1e6, 1e6, 0.001, 9), 0U);
    EXPECT_EQ(affordableCount(1e6 + 0.002, 1e6, 0.001, 9), 2U);
    EXPECT_EQ(affordableCount(std::numeric_limits<double>::infinity(), 5, 0.1, 7), 7U);
    EXPECT_EQ(affordableCount(0, 0, 1, 7), 0U);
}

TEST(Problem, NormalisedCostIsTheDecimalNumberMeant) {
    EXPECT_EQ(normaliseCost(0.1 + 0.2), 0.3);
    EXPECT_EQ(normaliseCost(327.8252249999999), 327.825225);
    EXPECT_EQ(normaliseCost(4 * 1e-9), 4e-9);
    EXPECT_EQ(normaliseCost(1e9 + 0.001), 1e9 + 0.001);
    EXPECT_EQ(normaliseCost(0), 0);
    // Costs that are no short decimal numbers stay unchanged.
    for (const double cost : {1.0 / 3, 2.0 / 3, 1e6 / 7, 1 + 1.0 / 3}) {
        EXPECT_FALSE(isCheaper(normaliseCost(cost), cost));
        EXPECT_FALSE(isCheaper(cost, normaliseCost(cost)));
    }
}

TEST(Problem, ViewsHangTogetherOverCellsThatCount) {
    const CandidateSet candidates = candidatesOf(8, {{0, 1}, {1, 2}, {2, 3}, {4, 5}, {3, 4}, {}});
    Problem problem;
    problem.weights = {1, 1, 1, 0, 1, 1, 1, 1};
    problem.kinds = {{&candidates, 6}};
    EXPECT_TRUE(isConnected(problem, {}));
    EXPECT_TRUE(isConnected(problem, {{0, 5}}));
    EXPECT_TRUE(isConnected(problem, {{0, 0}, {0, 2}, {0, 1}}));  // over one that comes later
    EXPECT_FALSE(isConnected(problem, {{0, 0}, {0, 2}}));
    EXPECT_FALSE(isConnected(problem, {{0, 2}, {0, 4}}));  // share a cell without weight
    EXPECT_TRUE(isConnected(problem, {{0, 3}, {0, 4}}));
    EXPECT_FALSE(isConnected(problem, {{0, 3}, {0, 5}}));
    problem.is_connected = true;
    EXPECT_FALSE(isFeasible(problem, {{0, 0}, {0, 2}}));
}

TEST(Problem, ThoseThatStandAreOnePart) {
    const CandidateSet candidates = candidatesOf(6, {{0, 1}, {4, 5}, {2}});
    Problem problem;
    problem.weights = {1, 1, 1, 0, 1, 1};
    problem.kinds = {{&candidates, 3}};
    problem.standing = CellSet(6);
    problem.standing.set(3);
    EXPECT_TRUE(isConnected(problem, {{0, 0}}));  // standing sensors see no cell of weight
    problem.standing.set(0);
    problem.standing.set(4);
    EXPECT_TRUE(isConnected(problem, {}));
    EXPECT_TRUE(isConnected(problem, {{0, 0}, {0, 1}}));
    EXPECT_FALSE(isConnected(problem, {{0, 2}}));
}

using Units = std::vector<std::uint32_t>;

TEST(WholeUnits, WholeWeightsStay) {
    EXPECT_EQ(integerWeights({0, 1, 20}), (Units{0, 1, 20}));
    EXPECT_EQ(integerWeights({}), Units());
}

TEST(WholeUnits, DecimalsAreScaledTogether) {
    EXPECT_EQ(integerWeights({1, 0.5, 2.25}), (Units{100, 50, 225}));
    EXPECT_EQ(integerWeights({0.1, 0.3}), (Units{1, 3})) << "as written, not as stored";
}

TEST(WholeUnits, SumsStayBelowTheLimit) {
    const std::vector<double> many(1000000, 1.0 / 3);
    std::uint64_t sum = 0;
    for (const std::uint32_t unit : integerWeights(many)) sum += unit;
    EXPECT_LT(sum, std::uint64_t{1} << 32U);
    EXPECT_GT(sum, 300'000'000U) << "and are not coarser than they must be";
}

/// The scale of before, which results of ordinary weights were made with.
Units unitsOfSixDecimals(const std::vector<double>& weights) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    double scale = 1;
    const auto is_whole = [&](double w) {
        return std::abs(w * scale - std::round(w * scale)) < 1e-9 * scale;
    };
    while (scale < 1e6 && !std::all_of(weights.begin(), weights.end(), is_whole) &&
           sum * scale * 10 < 4e9)
        scale *= 10;
    Units units;
    for (const double w : weights)
        units.push_back(static_cast<std::uint32_t>(std::llround(w * scale)));
    return units;
}

TEST(WholeUnits, OrdinaryWeightsHaveSixDecimals) {
    std::mt19937_64 random(3);
    const double ordinary[] = {0,   1,    2,     5,       0.5,     1.0 / 3, 0.1,  2.0 / 3,
                               0.2, 0.25, 0.125, 1.0 / 7, 0.12345, 10,      1000, 12.5};
    std::uniform_int_distribution<std::size_t> pick(0, std::size(ordinary) - 1);
    for (const std::size_t size : {1, 2, 3, 100, 10000, 40000})
        for (int i = 0; i < 30; ++i) {
            const double some[] = {ordinary[pick(random)], ordinary[pick(random)], 1};
            std::vector<double> weights;
            weights.reserve(size);
            for (std::size_t k = 0; k < size; ++k) weights.push_back(some[random() % 3]);
            ASSERT_EQ(integerWeights(weights), unitsOfSixDecimals(weights)) << size << ' ' << i;
        }
}

TEST(WholeUnits, SmallWeightsCountByTheLargest) {
    EXPECT_EQ(integerWeights({3.3333e-7, 0}), (Units{33333, 0}));
    EXPECT_EQ(integerWeights({3e-7, 1e-7, 0}), (Units{3, 1, 0}));
    EXPECT_EQ(integerWeights({2e-10}), (Units{2}));
    EXPECT_EQ(integerWeights({1e-8 / 3}), (Units{333333})) << "six digits";
    // Below the resolution beside the large one; but it is positive.
    EXPECT_EQ(integerWeights({1, 1e-12}), (Units{1000000, 1}));
    const double least = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(integerWeights({least, 0}), (Units{1, 0}));
}

TEST(WholeUnits, LargeWeightsAreScaledDown) {
    EXPECT_EQ(integerWeights({3e9, 1e9}), (Units{3000000000U, 1000000000U})) << "the sum fits";
    EXPECT_EQ(integerWeights({6e9, 2e9}), (Units{3000000000U, 1000000000U}));
    std::vector<double> many(10000, 1e6);
    EXPECT_EQ(integerWeights(many), Units(10000, 400000));
    // Small weights still count beside weights a million times as large.
    many.resize(1000000, 1);
    std::fill_n(many.begin(), 500000, 1e6);
    const Units units = integerWeights(many);
    EXPECT_EQ(units.front(), 8000U);
    EXPECT_EQ(units.back(), 1U);
    EXPECT_LT(std::accumulate(units.begin(), units.end(), std::uint64_t{0}),
              std::uint64_t{1} << 32U);
}

}  // namespace problem_test

}  // namespace ispace
