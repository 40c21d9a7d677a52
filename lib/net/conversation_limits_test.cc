// SPDX-License-Identifier: GPL-3.0-or-later
// What clients are kept from.
#include <gtest/gtest.h>

#include "net/conversation.h"
#include "net/test_talk.h"

namespace ispace {
namespace {

using testing::Talk;

TEST(Conversation, FirstLineThatIsNoRequestEnds) {
    Talk talk;
    for (const char* line : {"USER a", "GET / HTTP/1.1", "robot r1", "\xff\xfe", "{"}) {
        Conversation& client = talk.client();
        EXPECT_EQ(talk.ask(client, ""), "");
        EXPECT_EQ(talk.ask(client, line).substr(0, 8), "ERR 400 ");
        EXPECT_TRUE(client.closing()) << line;
    }
    EXPECT_EQ(talk.ask(talk.client(), "USER a"),
              "ERR 400 unknown request `USER`; HELP lists what there is; a first line that is no "
              "request ends the connection\n");
    // A request that cannot be met is one.
    for (const char* line : {"FORWARD 1", "ROBOT", "ROBOT r9", "WORLD w1", "HELP", "SHUTDOWN"}) {
        Conversation& client = talk.client();
        talk.ask(client, line);
        EXPECT_FALSE(client.closing()) << line;
        EXPECT_EQ(talk.ask(client, "USER a").substr(0, 8), "ERR 400 ");
        EXPECT_FALSE(client.closing());
    }
}

ServerLimits fewPauses() {
    ServerLimits limits;
    // None come back while a test runs.
    limits.pauses = {1e-6, 4};
    limits.all_pauses = {1e-6, 6};
    limits.spare_pauses = {1e-6, 1};
    return limits;
}

TEST(Conversation, PausesAreRationed) {
    Talk talk({Clock::Kind::Fast, 1}, {}, "", fewPauses());
    Conversation& first = talk.client("WORLD");
    Conversation& second = talk.client("WORLD");
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(talk.ask(first, "PAUSE"), "OK PAUSE t=0.000\n");
        EXPECT_EQ(talk.ask(first, "RESUME"), "OK RESUME t=0.000\n");
    }
    for (const char* request : {"PAUSE", "RESUME"})
        EXPECT_EQ(talk.ask(first, request),
                  std::string("ERR 429 ") + request +
                      " comes too often: a client has 1e-06 a second, all together 1e-06\n");
    EXPECT_FALSE(talk.room.simulation.paused());
    // Not what others have, which ends with the sum of all; and a pause can be ended.
    EXPECT_EQ(talk.ask(second, "PAUSE"), "OK PAUSE t=0.000\n");
    EXPECT_EQ(talk.ask(second, "PAUSE"), "OK PAUSE t=0.000\n");
    EXPECT_EQ(talk.ask(second, "PAUSE").substr(0, 8), "ERR 429 ");
    EXPECT_EQ(talk.ask(first, "RESUME"), "OK RESUME t=0.000\n");
    EXPECT_FALSE(talk.room.simulation.paused());
    // A connection of its own does not help.
    EXPECT_EQ(talk.ask(talk.client("WORLD"), "PAUSE").substr(0, 8), "ERR 429 ");
    EXPECT_EQ(talk.ask(first, "STATUS").substr(0, 8), "ERR 405 ");
    EXPECT_EQ(talk.ask(first, "TIME").substr(0, 8), "OK TIME ");
}

TEST(Conversation, WhoSeldomPausesMayWhereOthersFlood) {
    ServerLimits limits = fewPauses();
    limits.spare_pauses = {1e9, 1};
    Talk talk({Clock::Kind::Fast, 1}, {}, "", limits);
    Conversation& seldom = talk.client("WORLD");
    for (int i = 0; i < 3; ++i) {
        Conversation& flooding = talk.client("WORLD");
        for (int k = 0; k < 10; ++k) talk.ask(flooding, "PAUSE");
    }
    EXPECT_EQ(talk.ask(seldom, "PAUSE"), "OK PAUSE t=0.000\n");
}

TEST(Conversation, BehavedPausesAreNotNoticed) {
    Talk talk({Clock::Kind::Fast, 1});
    Conversation& world = talk.client("WORLD");
    for (int i = 0; i < 50; ++i) {
        ASSERT_EQ(talk.ask(world, "PAUSE").substr(0, 8), "OK PAUSE");
        ASSERT_EQ(talk.ask(world, "RESUME").substr(0, 9), "OK RESUME");
    }
}

TEST(Conversation, ShutdownMayBeRefused) {
    ServerLimits limits;
    limits.shutdown = false;
    Talk talk({Clock::Kind::Step, 1}, {}, "", limits);
    Conversation& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "SHUTDOWN"),
              "ERR 403 clients may not end this run: it has --no-shutdown\n");
    EXPECT_FALSE(talk.room.simulation.finished());
    EXPECT_FALSE(world.closing());
    EXPECT_EQ(talk.ask(world, "HELP"),
              "OK HELP LIST | TIME | POSES | PAUSE | RESUME | STEP [n] | HELP | QUIT\n");
}

}  // namespace
}  // namespace ispace
