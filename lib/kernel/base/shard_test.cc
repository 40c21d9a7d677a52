// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/shard.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace ispace {
namespace shard_test {

std::string refusal(const std::string& text) {
    try {
        return "taken as " + parseShard(text).text();
    } catch (const UsageError& error) {
        return error.what();
    }
}

TEST(ShardTest, IsReadFromOneOn) {
    EXPECT_EQ(parseShard("3/8"), (Shard{3, 8}));
    EXPECT_EQ(parseShard("1/1"), Shard());
    EXPECT_EQ((Shard{3, 8}).text(), "3/8");
    EXPECT_EQ(refusal("0/8"), "`0/8`: shards are counted from 1, the first is 1/8");
    EXPECT_EQ(refusal("9/8"), "`9/8`: there is no shard 9 of 8");
    for (const char* text : {"", "3", "/", "3/", "/8", "3/0", "-1/8", "3/8/9", "3 / 8", "a/b",
                             "3/8 ", "1/1000001", "1.5/2", "99999999999999999999/8"})
        EXPECT_NE(refusal(text).find("is not I/N"), std::string::npos) << refusal(text);
}

TEST(ShardTest, BlocksFollowEachOtherAndDifferByOneAtMost) {
    EXPECT_EQ((Shard{1, 3}).blockOf(8), (Shard::Block{0, 3}));
    EXPECT_EQ((Shard{2, 3}).blockOf(8), (Shard::Block{3, 6}));
    EXPECT_EQ((Shard{3, 3}).blockOf(8), (Shard::Block{6, 8}));
    for (const std::int64_t units : {0, 1, 2, 7, 100, 101})
        for (const int count : {1, 2, 3, 7, 100, 106}) {
            std::int64_t next = 0, least = units, most = 0;
            for (int i = 1; i <= count; ++i) {
                const Shard::Block block = Shard{i, count}.blockOf(units);
                EXPECT_EQ(block.first, next);
                next = block.end;
                least = std::min(least, block.end - block.first);
                most = std::max(most, block.end - block.first);
            }
            EXPECT_EQ(next, units);
            EXPECT_LE(most - least, 1);
        }
}

}  // namespace shard_test
}  // namespace ispace
