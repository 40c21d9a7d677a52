// SPDX-License-Identifier: GPL-3.0-or-later
// Places and memory that clients may take without giving anything for it.
#include "server/server_state.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>
#include <vector>

#include "support/test_client.h"

namespace ispace {

namespace server_limits_test {

using testing::Client;
using testing::Running;
using testing::soon;
using testing::step;

constexpr const char* kNoRole =
    "ERR 408 no role taken in time: ROBOT id, SENSOR id or WORLD comes first\n";

TEST(Server, ConnectionWithoutARoleEnds) {
    ServerLimits limits;
    limits.roleless = std::chrono::seconds(1);
    Running running({Clock::Kind::Step, 1}, limits);
    Client silent(running.port()), dribbling(running.port()), blank(running.port());
    Client reader(running.port()), robot(running.port());
    reader.take("LASER l1");
    robot.take("ROBOT r1");
    for (Client* client : {&silent, &dribbling, &blank})
        EXPECT_EQ(client->connect().line(), "ISPACE 1");
    std::thread sender([&] {
        for (int i = 0; i < 6000 && dribbling.send("x") && blank.send("\n"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
    });
    for (Client* client : {&silent, &dribbling, &blank}) EXPECT_EQ(client->rest(), kNoRole);
    sender.join();
    // Roles make no noise.
    EXPECT_EQ(reader.ask("STOP"), "OK STOP");
    EXPECT_EQ(robot.ask("STOP"), "OK STOP");
}

TEST(Server, RequestsKeepAConnectionWithoutARole) {
    ServerLimits limits;
    limits.roleless = std::chrono::milliseconds(1500);
    Running running({Clock::Kind::Step, 1}, limits);
    Client client(running.port());
    EXPECT_EQ(client.connect().line(), "ISPACE 1");
    for (int i = 0; i < 40; ++i) {
        EXPECT_EQ(client.ask("HELP").substr(0, 8), "OK HELP ");
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    EXPECT_EQ(client.ask("WORLD").substr(0, 9), "OK WORLD ");
}

TEST(Server, SilentConnectionsKeepNobodyOut) {
    ServerLimits limits;
    limits.clients = 3;
    limits.roleless_grace = std::chrono::milliseconds(100);
    Running running({Clock::Kind::Step, 1}, limits);
    Client reader(running.port()), silent(running.port()), asking(running.port());
    reader.take("LASER l1");
    EXPECT_EQ(silent.connect().line(), "ISPACE 1");
    EXPECT_EQ(asking.connect().line(), "ISPACE 1");
    std::this_thread::sleep_for(2 * limits.roleless_grace);
    EXPECT_EQ(asking.ask("HELP").substr(0, 8), "OK HELP ");
    Client first(running.port()), second(running.port()), third(running.port());
    first.take("WORLD");
    EXPECT_EQ(silent.rest(), kNoRole);
    std::this_thread::sleep_for(2 * limits.roleless_grace);
    second.take("WORLD");
    EXPECT_EQ(asking.rest(), kNoRole);
    // Clients with a role stay.
    std::this_thread::sleep_for(2 * limits.roleless_grace);
    EXPECT_EQ(third.connect().rest(), "ERR 429 too many clients (3): try again later\n");
    EXPECT_EQ(reader.ask("STOP"), "OK STOP");
}

TEST(Server, HundredsOfSilentConnectionsKeepNobodyOut) {
    ServerLimits limits;
    limits.clients = 16;
    limits.roleless_grace = std::chrono::milliseconds(1);
    Running running({Clock::Kind::Step, 1}, limits);
    std::vector<std::unique_ptr<Client>> silent;
    for (int i = 0; i < 300; ++i) {
        silent.push_back(std::make_unique<Client>(running.port()));
        silent.back()->connect();
    }
    EXPECT_TRUE(soon([&] {
        Client client(running.port());
        return client.connect().line() == "ISPACE 1" &&
               client.ask("WORLD").starts_with("OK WORLD ");
    }));
}

/// Of a connection of this machine, as /proc/net/tcp has it; 2 is that of keep-alive.
int timerOf(std::uint16_t from, std::uint16_t to) {
    std::ifstream table("/proc/net/tcp");
    std::string line;
    while (std::getline(table, line)) {
        std::istringstream words(line);
        std::string number, local, remote, state, queues, timer;
        words >> number >> local >> remote >> state >> queues >> timer;
        const auto port = [](const std::string& end) {
            return std::stoi(end.substr(end.find(':') + 1), nullptr, 16);
        };
        if (number == "sl") continue;
        if (port(local) == from && port(remote) == to) return std::stoi(timer.substr(0, 2));
    }
    return -1;
}

TEST(Server, AsksPeersThatAreSilentWhetherTheyAreThere) {
    if (!std::ifstream("/proc/net/tcp")) GTEST_SKIP() << "no /proc/net/tcp";
    Running running;
    Client reader(running.port());
    reader.take("LASER l1");
    EXPECT_TRUE(soon([&] { return timerOf(running.port(), reader.port()) == 2; }));
}

TEST(Server, WhatStalledReadersHoldIsBoundedInSum) {
    constexpr int kStalled = 30;
    ServerLimits limits;
    limits.clients = 40;
    limits.unread = std::size_t{1} << 20;
    // Scans of 120 kB; more than the system takes for a client that does not read.
    Running running({Clock::Kind::Step, 1}, limits,
                    "laser id=big at=0,1 fov=360 step=0.018 range=20\n");
    Client world(running.port()), honest(running.port()), small(running.port(), 2048);
    world.take("WORLD");
    EXPECT_EQ(honest.take("LASER big").ask("STREAM"), "OK STREAM every=1");
    EXPECT_EQ(small.take("LASER l1").ask("STREAM"), "OK STREAM every=1");
    std::vector<std::unique_ptr<Client>> stalled;
    for (int i = 1; i <= 60; ++i) {
        if (i <= kStalled) {
            // Half of them by scans of a stream, half by replies; each holds another scan.
            stalled.push_back(std::make_unique<Client>(running.port(), 2048));
            stalled.back()->take("LASER big").send(i % 2 == 0 ? "STREAM\n" : "SCAN\nSCAN\nSCAN\n");
        }
        ASSERT_EQ(step(world, 1).substr(0, 11), "OK STEP n=1");
        const std::string scan = honest.line();
        ASSERT_NE(scan.find(" seq=" + std::to_string(i) + " "), std::string::npos);
    }
    int cut = 0;
    for (const auto& client : stalled) {
        client->send("QUIT\n");
        const std::string all = client->rest();
        cut += all.ends_with("\nERR 429 too much unread: the slowest readers are disconnected\n");
    }
    EXPECT_GE(cut, kStalled - 9) << "more than 1 MiB of scans of 120 kB are held";
    // Clients that read, or hold little, stay.
    EXPECT_EQ(honest.ask("STOP"), "OK STOP");
    small.send("STOP\n");
    std::string line = small.line();
    while (line.starts_with("SCAN l1 ")) line = small.line();
    EXPECT_EQ(line, "OK STOP");
}

/// Streams scans of 120 kB to a reader that begins late. \returns how many of them it gets
int scansOfALateReader(bool waits, ReaderLosses& losses) {
    ServerLimits limits;
    limits.waits_for_readers = waits;
    limits.watchdog = std::chrono::seconds(30);
    int count = 0;
    Running running({Clock::Kind::Step, 1}, limits,
                    "laser id=big at=0,1 fov=360 step=0.018 range=20\n");
    Client world(running.port()), late(running.port(), 2048);
    world.take("WORLD");
    EXPECT_EQ(late.take("LASER big").ask("STREAM"), "OK STREAM every=1");
    EXPECT_TRUE(world.send("STEP 100\n"));
    const auto expect_end = [&world] { EXPECT_EQ(world.line().substr(0, 13), "OK STEP n=100"); };
    if (waits) {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        EXPECT_TRUE(world.quiet()) << "the world waits for the reader";
    } else {
        expect_end();  // before the reader begins
    }
    std::thread reader([&late, &count] {
        for (std::string line = late.line(); line.starts_with("SCAN "); line = late.line()) ++count;
    });
    if (waits) expect_end();
    EXPECT_TRUE(late.send("STOP\n"));
    reader.join();
    running.stop();
    losses = running.server().readerLosses();
    return count;
}

TEST(Server, WaitsForReadersOnRequest) {
    ReaderLosses losses;
    EXPECT_EQ(scansOfALateReader(true, losses), 100);
    EXPECT_EQ(losses.readings, 0);
    const int count = scansOfALateReader(false, losses);
    EXPECT_LT(count, 100);
    EXPECT_EQ(losses.readings, 100 - count) << "and says how many are lost";
}

TEST(Server, WaitsNoLongerThanTheWatchdog) {
    ServerLimits limits;
    limits.waits_for_readers = true;
    limits.watchdog = std::chrono::milliseconds(200);
    Running running({Clock::Kind::Step, 1}, limits,
                    "laser id=big at=0,1 fov=360 step=0.018 range=20\n");
    Client world(running.port()), stalled(running.port(), 2048);
    world.take("WORLD");
    EXPECT_EQ(stalled.take("LASER big").ask("STREAM"), "OK STREAM every=1");
    EXPECT_EQ(world.ask("STEP 100").substr(0, 13), "OK STEP n=100");
}

using std::chrono::milliseconds;

int taken(TokenBucket& bucket, WallTime now) {
    int count = 0;
    for (; bucket.has(now); ++count) bucket.take();
    return count;
}

TEST(TokenBucket, GivesABurstAndThenItsRate) {
    const WallTime start{std::chrono::hours(1)};
    TokenBucket bucket({.rate = 10, .burst = 5});
    EXPECT_EQ(taken(bucket, start), 5);
    EXPECT_EQ(taken(bucket, start + milliseconds(99)), 0);
    EXPECT_EQ(taken(bucket, start + milliseconds(101)), 1);
    EXPECT_EQ(taken(bucket, start + milliseconds(302)), 2);
    EXPECT_EQ(taken(bucket, start + std::chrono::hours(1)), 5);
}

TEST(TokenBucket, MayBeginEmpty) {
    const WallTime start{std::chrono::hours(1)};
    TokenBucket bucket({.rate = 1, .burst = 1}, start);
    EXPECT_EQ(taken(bucket, start), 0);
    EXPECT_EQ(taken(bucket, start + milliseconds(999)), 0);
    EXPECT_EQ(taken(bucket, start + milliseconds(1001)), 1);
}

TEST(TokenBucket, CountsWhatComesInSmallPieces) {
    const WallTime start{std::chrono::hours(1)};
    TokenBucket bucket({.rate = 10, .burst = 5});
    int count = 0;
    for (int ms = 0; ms <= 2000; ++ms) count += taken(bucket, start + milliseconds(ms));
    EXPECT_GE(count, 24);
    EXPECT_LE(count, 25);
}

TEST(TokenBucket, SurvivesAClockThatDoesNotMove) {
    const WallTime start{std::chrono::hours(1)};
    TokenBucket bucket({.rate = 1, .burst = 2});
    EXPECT_EQ(taken(bucket, start), 2);
    EXPECT_EQ(taken(bucket, start), 0);
    EXPECT_EQ(taken(bucket, start - milliseconds(5000)), 0);
}

}  // namespace server_limits_test

}  // namespace ispace
