// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/strategy.h"

#include <gtest/gtest.h>

#include <set>

#include "place/test_arrange.h"

namespace ispace {
namespace {

TEST(Strategies, NamesAndOptionsAreDistinct) {
    std::set<std::string_view> names, options;
    for (const StrategyRow& row : strategies()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_EQ(&rowOf(row.strategy), &row);
        EXPECT_EQ(strategyNamed(row.name), &row);
        EXPECT_EQ(nameOf(row.strategy), row.name);
        for (const StrategyOption& option : row.options) {
            EXPECT_TRUE(options.insert(option.name).second) << option.name;
            EXPECT_LT(option.lowest, option.highest);
        }
    }
    EXPECT_EQ(strategyNamed("nothing"), nullptr);
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

}  // namespace
}  // namespace ispace
