// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/record.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace ispace {
namespace id_table_test {

TEST(IdTable, FindsTheFirstOfEachId) {
    std::vector<std::string> ids;
    for (int i = 0; i < 1000; ++i)
        ids.push_back(i % 7 == 0 ? "" : "wall" + std::to_string(i % 500));
    const IdTable table(ids.size(), [&ids](std::size_t i) { return std::string_view(ids[i]); });
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (ids[i].empty()) continue;
        const auto found = table.find(ids[i]);
        ASSERT_TRUE(found);
        EXPECT_EQ(ids[*found], ids[i]);
        EXPECT_LE(*found, i);
    }
    EXPECT_FALSE(table.find("wall500"));
    EXPECT_FALSE(table.find(""));
}

TEST(IdTable, OfNothingHasNothing) {
    const IdTable table(0, [](std::size_t) { return std::string_view(); });
    EXPECT_FALSE(table.find("wall1"));
}

}  // namespace id_table_test
}  // namespace ispace
