// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/message.h"

#include <gtest/gtest.h>

namespace ispace {

namespace program_test {

TEST(ShellQuote, LeavesPlainWordsAlone) {
    for (const char* word : {"arrange", "--sensor", "urg-04lx:3", "a/b.env", "0.25,0.25,16", "-X",
                             "KEY=VALUE", "95%", "c++", "l1@r1"})
        EXPECT_EQ(shellQuote(word), word);
}

TEST(ShellQuote, QuotesWhatAShellWouldChange) {
    EXPECT_EQ(shellQuote(""), "''");
    EXPECT_EQ(shellQuote("my room.env"), "'my room.env'");
    EXPECT_EQ(shellQuote("0,0;8,0"), "'0,0;8,0'");
    EXPECT_EQ(shellQuote("it's"), R"('it'\''s')");
    EXPECT_EQ(shellQuote("$HOME"), "'$HOME'");
    EXPECT_EQ(shellQuote("*"), "'*'");
    EXPECT_EQ(shellQuote("#x"), "'#x'");
    EXPECT_EQ(shellQuote("~"), "'~'");
    EXPECT_EQ(shellQuote("h\xc3\xb6he"), "'h\xc3\xb6he'");
}

TEST(ShellQuote, StaysOneLineOfText) {
    EXPECT_EQ(shellQuote("a\nb\tc\x1b d\x7f"), "'a?b?c? d?'");
    EXPECT_EQ(shellQuote(std::string_view("a\0b", 3)), "'a?b'");
    EXPECT_EQ(shellQuote("r\xe9sum\xe9"), "'r?sum?'");
}

TEST(BaseName, IsTheLastPart) {
    EXPECT_EQ(baseName("room.env"), "room.env");
    EXPECT_EQ(baseName("/a/b/room.env"), "room.env");
    EXPECT_EQ(baseName("../room.env"), "room.env");
    EXPECT_EQ(baseName("a/b/"), "b");
    EXPECT_EQ(baseName("a//"), "a");
    EXPECT_EQ(baseName("/"), "/");
    EXPECT_EQ(baseName("//"), "/");
    EXPECT_EQ(baseName("-"), "-");
    EXPECT_EQ(baseName(""), "");
}

}  // namespace program_test

}  // namespace ispace
