// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/strategy.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "support/test_arrange.h"

namespace ispace {
namespace strategy_test {

TEST(Strategies, NamesAndOptionsAreDistinct) {
    std::set<std::string_view> names;
    std::map<std::string_view, std::string_view> helps;
    for (const StrategyRow& row : strategies()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_EQ(&rowOf(row.strategy), &row);
        EXPECT_EQ(strategyNamed(row.name), &row);
        EXPECT_EQ(nameOf(row.strategy), row.name);
        for (const StrategyOption& option : row.options) {
            EXPECT_EQ(helps.try_emplace(option.name, option.help).first->second, option.help);
            EXPECT_LE(option.lowest, option.highest);
            EXPECT_TRUE(takes(row.strategy, MountOn::Floor, option)) << option.name;
        }
    }
    EXPECT_EQ(strategyNamed("nothing"), nullptr);
}

TEST(Strategies, TakeTheirOwnOptionsAndThoseOfTheMount) {
    const StrategyOption& density = rowOf(Strategy::All).options.front();
    EXPECT_TRUE(takes(Strategy::Medial, MountOn::Floor, density));
    EXPECT_FALSE(takes(Strategy::Grid, MountOn::Floor, density));
    const StrategyOption& distance = rowOf(Strategy::Wall).options.front();
    EXPECT_FALSE(takes(Strategy::All, MountOn::Floor, distance));
    EXPECT_TRUE(takes(Strategy::All, MountOn::Wall, distance));
}

TEST(Strategies, ProposeFromTheirOptions) {
    const Environment room = roomOf("ispace size=8,6\n");
    ArrangeOptions options;
    options.list = {{{1, 2}, {Angle()}}};
    const auto proposed = [&](Strategy strategy) {
        options.strategy = strategy;
        return rowOf(strategy).propose({room, kScanHeight, 5, options});
    };
    EXPECT_EQ(proposed(Strategy::List), options.list);
    EXPECT_TRUE(proposed(Strategy::Random).empty());
    EXPECT_FALSE(proposed(Strategy::Medial).empty());
    for (const Site& site : proposed(Strategy::All)) ASSERT_EQ(site.headings.size(), 16U);
    options.x = 3, options.y = 4;
    const std::vector<Site> grid = proposed(Strategy::Grid);
    ASSERT_EQ(grid.size(), 12U);
    EXPECT_EQ(grid.front().headings.size(), 8U);
    options.times = 3;
    EXPECT_EQ(proposed(Strategy::Wall).size(), 12U);
    options.headings = 5;
    for (const Site& site : proposed(Strategy::Wall)) EXPECT_EQ(site.headings.size(), 5U);
    EXPECT_EQ(proposed(Strategy::Grid).front().headings.size(), 5U);
}

}  // namespace strategy_test
}  // namespace ispace
