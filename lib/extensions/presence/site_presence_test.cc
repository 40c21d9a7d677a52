// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/presence/site_presence.h"

#include <gtest/gtest.h>

#include <vector>

namespace ispace::presence {
namespace site_presence_test {

TEST(BuildingPresence, SumsAreOfAllWays) {
    std::vector<Presence> storeys(2);
    storeys[0] = {{{"ann", 10, 0.5, 3}}, {"", 10, 0.5, 3}, {{"g/p", 0.5, 0.25}}};
    storeys[1] = {{{"ann", 30, 1, 0}, {"bob", 10, 0, 10}}, {"", 40, 0.75, 10}, {{"u/q", 1, 1}}};
    const Presence sum = sumOverStoreys(storeys);
    ASSERT_EQ(sum.people.size(), 2U);
    EXPECT_DOUBLE_EQ(sum.people[0].length, 40);
    EXPECT_DOUBLE_EQ(sum.people[0].share, 35.0 / 40);
    EXPECT_DOUBLE_EQ(sum.all.share, 35.0 / 50);
    EXPECT_DOUBLE_EQ(sum.all.longest_gap, 10);
    EXPECT_DOUBLE_EQ(sum.sensors[0].share, 0.5 * 10 / 50);
    EXPECT_DOUBLE_EQ(sum.sensors[1].marginal, 40.0 / 50);
}

}  // namespace site_presence_test
}  // namespace ispace::presence
