// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/budget.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace ispace {
namespace budget_test {

TEST(Budget, FollowsTheSizeBetweenItsBounds) {
    EXPECT_EQ(Budget(0).limit(), Budget::kMinValue);
    EXPECT_EQ(Budget(1000).limit(), Budget::kMinValue + 1000 * Budget::kPerByte);
    EXPECT_EQ(Budget(1'000'000'000).limit(), Budget::kMaxWork);
    EXPECT_EQ(Budget(SIZE_MAX).limit(), Budget::kMaxWork);
    EXPECT_EQ(Budget(SIZE_MAX, {7}).limit(), 7U);
}

TEST(Budget, GrowsWithSideFiles) {
    Budget budget(1000);
    budget.grant(500);
    EXPECT_EQ(budget.limit(), Budget::kMinValue + 1500 * Budget::kPerByte);
    for (int i = 0; i < 3; ++i) budget.grant(SIZE_MAX);
    EXPECT_EQ(budget.limit(), Budget::kMaxWork);
}

TEST(Budget, TakesAllOrNothing) {
    Budget budget(0, {10});
    EXPECT_TRUE(budget.take(7));
    EXPECT_FALSE(budget.take(4));
    EXPECT_EQ(budget.left(), 3U);
    EXPECT_TRUE(budget.take(3));
    EXPECT_FALSE(budget.take(1));
    EXPECT_TRUE(budget.take(0));
    EXPECT_FALSE(budget.take(UINT64_MAX));
}

TEST(Budget, OfAPartIsBoundedByThatOfTheWhole) {
    Budget whole(0, {10});
    Budget first(0, {8, &whole}), second(0, {8, &whole});
    EXPECT_TRUE(first.take(7));
    EXPECT_EQ(second.left(), 3U);
    EXPECT_FALSE(first.take(2));
    EXPECT_EQ(first.excess().substr(0, 11), "more than 8");
    EXPECT_EQ(whole.left(), 3U) << "a part that is refused takes none of the whole";
    EXPECT_FALSE(second.take(4));
    EXPECT_TRUE(whole.isExceeded());
    EXPECT_EQ(second.excess().substr(0, 12), "more than 10");
    EXPECT_TRUE(second.take(3));
}

TEST(Budget, SaysHowToAllowMore) {
    EXPECT_EQ(Budget(0, {10}).excess(), "more than 10 units of work (`--max-work 20` allows more)");
}

}  // namespace budget_test
}  // namespace ispace
