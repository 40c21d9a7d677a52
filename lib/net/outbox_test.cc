// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/outbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace ispace {
namespace {

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

}  // namespace
}  // namespace ispace
