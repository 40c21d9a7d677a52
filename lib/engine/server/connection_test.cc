// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/client_connection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace ispace {

namespace connection_test {

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

TEST(Outbox, ScanGoesInOnePieceBeforeLaterReplies) {
    Outbox box;
    EXPECT_EQ(box.front(), "");
    box.put(std::make_shared<const std::string>("scan\n"));
    box.pop(2);
    box.append("reply\n");
    EXPECT_EQ(box.unsent(), 6U);
    EXPECT_EQ(box.front(), "an\n");
    box.pop(3);
    EXPECT_EQ(box.front(), "reply\n");
    EXPECT_EQ(box.unsent(), 6U);
    box.pop(6);
    EXPECT_EQ(box.front(), "");
    EXPECT_EQ(box.unsent(), 0U);
}

TEST(Outbox, ScanIsNotKeptOnceSent) {
    Outbox box;
    auto scan = std::make_shared<const std::string>("scan\n");
    box.put(scan);
    EXPECT_EQ(scan.use_count(), 2);
    box.pop(5);
    EXPECT_EQ(scan.use_count(), 1);
}

TEST(Outbox, AbandonsWhatIsNotSent) {
    Outbox box;
    EXPECT_FALSE(box.abandon());
    box.append("one\ntwo\n");
    box.pop(4);
    EXPECT_FALSE(box.abandon());
    EXPECT_EQ(box.front(), "");
    auto scan = std::make_shared<const std::string>("scan\n");
    box.put(scan);
    box.append(std::string(1 << 20, 'x'));
    EXPECT_EQ(box.scanBytes(), 5U);
    EXPECT_GE(box.textMemory(), std::size_t{1} << 20);
    box.pop(1);
    EXPECT_TRUE(box.abandon());
    EXPECT_EQ(scan.use_count(), 1);
    EXPECT_EQ(box.unsent(), 0U);
    EXPECT_LT(box.textMemory(), 100U);
    box.append("\n");
    box.pop(1);
    EXPECT_FALSE(box.abandon());
}

TEST(Outbox, BytesComeOutAsTheyWentIn) {
    std::mt19937 random(3);
    Outbox box;
    std::string in, out;
    const auto send = [&](std::size_t most) {
        const std::string_view piece = box.front().substr(0, most);
        out += piece;
        const std::size_t size = piece.size();
        box.pop(size);
    };
    for (int i = 0; i < 3000; ++i) {
        const std::string text(random() % 50, static_cast<char>('a' + i % 26));
        if (box.front().empty() && !text.empty() && i % 2 == 0)
            box.put(std::make_shared<const std::string>(text));
        else
            box.append(text);
        in += text;
        send(random() % 60);
    }
    while (!box.front().empty()) send(1000);
    EXPECT_EQ(out, in);
}

}  // namespace connection_test

}  // namespace ispace
