// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/message.h"

#include <gtest/gtest.h>

namespace ispace {

namespace message_test {

TEST(Utf8Length, KnowsTheBoundsOfEachLength) {
    EXPECT_EQ(utf8Length(""), 0U);
    EXPECT_EQ(utf8Length(std::string_view("\0", 1)), 1U);
    EXPECT_EQ(utf8Length("\x7f"), 1U);
    EXPECT_EQ(utf8Length("\xc2\x80"), 2U);
    EXPECT_EQ(utf8Length("\xe0\xa0\x80"), 3U);
    EXPECT_EQ(utf8Length("\xed\x9f\xbf"), 3U);
    EXPECT_EQ(utf8Length("\xf0\x90\x80\x80"), 4U);
    EXPECT_EQ(utf8Length("\xf4\x8f\xbf\xbf"), 4U);
    for (const char* bad :
         {"\x80", "\xbf", "\xc0\x80", "\xc1\xbf", "\xc2", "\xc2z", "\xe0\x9f\xbf", "\xe2\x82",
          "\xed\xa0\x80", "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff"})
        EXPECT_EQ(utf8Length(bad), 0U);
}

TEST(Printable, HasNoControlCharacters) {
    EXPECT_EQ(printable("h\xc3\xb6he"), "h\xc3\xb6he");
    EXPECT_EQ(printable("a\x1b[31m\n\x7f\xc2\x9b\xff"), "a?[31m????");
}

TEST(Excerpt, IsShort) {
    EXPECT_EQ(excerpt(""), "``");
    EXPECT_EQ(excerpt("tall"), "`tall`");
    EXPECT_EQ(excerpt(std::string(60, 'x')), '`' + std::string(60, 'x') + '`');
    EXPECT_EQ(excerpt(std::string(61, 'x')), '`' + std::string(60, 'x') + "...`");
    // Never cuts a character in two.
    EXPECT_EQ(excerpt(std::string(59, 'x') + "\xc3\xb6\xc3\xb6"),
              '`' + std::string(59, 'x') + "...`");
}

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

}  // namespace message_test

}  // namespace ispace
