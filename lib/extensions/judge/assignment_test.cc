// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/judge/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace ispace::judge {
namespace assignment_test {

double sumOf(const Matrix& gains, const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
    double sum = 0;
    for (const auto& [row, column] : pairs) sum += gains.at(row, column);
    return sum;
}

/// Tries all matchings.
double bestSum(const Matrix& gains) {
    const bool is_tall = gains.columns < gains.rows;
    std::vector<std::size_t> order(std::max(gains.rows, gains.columns));
    std::iota(order.begin(), order.end(), std::size_t{0});
    double best = -HUGE_VAL;
    do {
        double sum = 0;
        for (std::size_t i = 0; i < std::min(gains.rows, gains.columns); ++i)
            sum += is_tall ? gains.at(order[i], i) : gains.at(i, order[i]);
        best = std::max(best, sum);
    } while (std::next_permutation(order.begin(), order.end()));
    return best;
}

TEST(Assignment, IsTheBestOfAllMatchings) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> gain(-1, 1);
    for (int round = 0; round < 300; ++round) {
        Matrix gains{1 + random() % 6, 1 + random() % 6};
        for (double& one : gains.values) one = gain(random);
        const auto pairs = bestAssignment(gains);
        ASSERT_EQ(pairs.size(), std::min(gains.rows, gains.columns));
        ASSERT_NEAR(sumOf(gains, pairs), bestSum(gains), 1e-12) << round;
    }
}

TEST(Assignment, EqualGainsMatchInOrder) {
    for (const auto& [rows, columns] : {std::pair(3, 3), std::pair(2, 4), std::pair(4, 2)}) {
        const Matrix gains{static_cast<std::size_t>(rows), static_cast<std::size_t>(columns)};
        const auto pairs = bestAssignment(gains);
        for (std::size_t i = 0; i < pairs.size(); ++i) EXPECT_EQ(pairs[i], std::pair(i, i));
    }
}

TEST(Assignment, OfNoRowOrColumnIsEmpty) {
    EXPECT_TRUE(bestAssignment(Matrix{0, 3}).empty());
    EXPECT_TRUE(bestAssignment(Matrix{3, 0}).empty());
}

}  // namespace assignment_test
}  // namespace ispace::judge
