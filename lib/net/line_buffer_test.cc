// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/line_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace ispace {
namespace {

std::vector<std::string> takeAll(LineBuffer& buffer) {
    std::vector<std::string> lines;
    while (buffer.ready()) lines.emplace_back(buffer.take());
    return lines;
}

TEST(LineBuffer, TakesLinesWithEitherEnd) {
    LineBuffer buffer(10);
    EXPECT_FALSE(buffer.ready());
    buffer.append("one\ntwo\r\n\n\r\nth");
    EXPECT_EQ(takeAll(buffer), (std::vector<std::string>{"one", "two", "", ""}));
    buffer.append("ree");
    EXPECT_FALSE(buffer.ready());
    buffer.append("\r");
    buffer.append("\n");
    EXPECT_EQ(takeAll(buffer), (std::vector<std::string>{"three"}));
}

TEST(LineBuffer, OnlyTheLastReturnIsPartOfTheEnd) {
    LineBuffer buffer(10);
    buffer.append("a\rb\r\r\n");
    EXPECT_EQ(takeAll(buffer), (std::vector<std::string>{"a\rb\r"}));
}

TEST(LineBuffer, LimitIsWithoutTheEnd) {
    for (const std::string end : {"", "\n", "\r", "\r\n"}) {
        LineBuffer fits(5), long_one(5);
        fits.append("12345" + end);
        EXPECT_FALSE(fits.tooLong());
        long_one.append("123456" + end);
        EXPECT_TRUE(long_one.tooLong());
    }
    LineBuffer second(5);
    second.append("1\n123456");
    EXPECT_FALSE(second.tooLong());
    EXPECT_EQ(second.take(), "1");
    EXPECT_TRUE(second.tooLong());
}

TEST(LineBuffer, BlocksDoNotMatter) {
    std::mt19937 random(7);
    std::string text;
    for (int i = 0; i < 4000; ++i) text += "ab\r\n\n"[random() % 5];
    text += '\n';
    LineBuffer whole(text.size());
    whole.append(text);
    const std::vector<std::string> wanted = takeAll(whole);
    LineBuffer pieces(text.size());
    std::vector<std::string> found;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t size = std::min<std::size_t>(1 + random() % 7, text.size() - at);
        pieces.append(std::string_view(text).substr(at, size));
        at += size;
        // Sometimes lines wait for the next block.
        if (random() % 3 == 0) continue;
        for (std::string& line : takeAll(pieces)) found.push_back(std::move(line));
    }
    for (std::string& line : takeAll(pieces)) found.push_back(std::move(line));
    EXPECT_EQ(found, wanted);
    EXPECT_GT(wanted.size(), 1000U);
}

}  // namespace
}  // namespace ispace
