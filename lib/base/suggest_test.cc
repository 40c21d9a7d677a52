// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/suggest.h"

#include <gtest/gtest.h>

namespace ispace {
namespace {

const std::vector<std::string> kKeys = {"id", "at", "heading", "size", "height", "kind"};

TEST(Suggest, FindsTheWordThatWasMeant) {
    EXPECT_EQ(nearestWord("heigth", kKeys), "height") << "neighbours swapped";
    EXPECT_EQ(nearestWord("hight", kKeys), "height") << "a letter missing";
    EXPECT_EQ(nearestWord("sizes", kKeys), "size") << "a letter too many";
    EXPECT_EQ(nearestWord("heading", kKeys), "heading");
    EXPECT_EQ(nearestWord("hedding", kKeys), "heading");
    EXPECT_EQ(nearestWord("HEIGHT", kKeys), "height") << "in capitals";
    EXPECT_EQ(nearestWord("rplidar-A1", {"RPLidar-A2", "RPLidar-A1"}), "RPLidar-A1");
}

TEST(Suggest, IsSilentWhereNothingIsNear) {
    EXPECT_EQ(nearestWord("colour", kKeys), "");
    EXPECT_EQ(nearestWord("x", kKeys), "") << "any two-letter word would do";
    EXPECT_EQ(nearestWord("", kKeys), "");
    EXPECT_EQ(nearestWord("height", {}), "");
    EXPECT_EQ(nearestWord(std::string(100000, 'h'), kKeys), "");
}

TEST(Suggest, TheNearestWinsThenTheFirst) {
    EXPECT_EQ(nearestWord("wal", {"wall", "wad"}), "wall");
    EXPECT_EQ(nearestWord("cat", {"bat", "rat"}), "bat");
    EXPECT_EQ(nearestWord("bats", {"rats", "bat"}), "rats");
}

TEST(Suggest, MakesTheEndOfAMessage) {
    EXPECT_EQ(didYouMean("heigth", kKeys), ", did you mean `height`?");
    EXPECT_EQ(didYouMean("colour", kKeys), "");
}

}  // namespace
}  // namespace ispace
