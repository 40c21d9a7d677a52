// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/server.h"

#include <gtest/gtest.h>

#include <array>
#include <system_error>
#include <thread>
#include <utility>

#include "base/error.h"
#include "support/test_client.h"

namespace ispace {

namespace server_test {

using testing::Client;
using testing::comes;
using testing::Running;
using testing::step;

TEST(Server, SaysWhereItListens) {
    Running running;
    EXPECT_EQ(running.server().address(), "127.0.0.1:" + std::to_string(running.port()));
    EXPECT_GT(running.port(), 0);
}

TEST(Server, ListensOnIpv6) {
    testing::TestWorld room;
    try {
        Server server(room.simulation, parseEndpoint("[::1]:0"));
        EXPECT_EQ(server.address(), "[::1]:" + std::to_string(server.port()));
    } catch (const std::system_error& error) {
        GTEST_SKIP() << error.what();  // a machine without it
    }
}

TEST(Server, NamesThePortThatIsTaken) {
    Running running;
    testing::TestWorld room;
    const std::string address = running.server().address();
    try {
        Server second(room.simulation, parseEndpoint(address));
        FAIL();
    } catch (const std::system_error& error) {
        EXPECT_EQ(error.code(), std::errc::address_in_use);
        // The name of a file would end at the last colon.
        EXPECT_EQ(std::string(error.what()),
                  "cannot listen on " + address +
                      " (Address already in use): stop the program that listens there, or take "
                      "another port, 0 for a free one");
    }
}

TEST(Server, ServesADialogue) {
    Running running;
    Client robot(running.port()), world(running.port());
    robot.take("ROBOT r2");
    world.take("WORLD");
    EXPECT_EQ(robot.ask("FORWARD 0.25"), "OK FORWARD id=1 distance=0.25");
    EXPECT_EQ(step(world, 9), "OK STEP n=9 t=0.900");
    EXPECT_EQ(step(world, 1), "OK STEP n=1 t=1.000");
    EXPECT_EQ(robot.line(), "DONE id=1 t=1.000");
    EXPECT_EQ(robot.ask("STATUS"),
              "OK STATUS t=1.000 x=2.000 y=1.750 heading=90.000 speed=0.000 rotspeed=0.000 "
              "accel=0 rotaccel=0 stall=0");
    EXPECT_EQ(robot.ask("QUIT\r"), "OK QUIT");
    EXPECT_EQ(robot.rest(), "");
}

TEST(Server, RobotIsFreeWhenItsClientIsGone) {
    Running running;
    Client second(running.port());
    second.connect();
    EXPECT_EQ(second.line(), "ISPACE 1");
    for (const bool politely : {true, false}) {
        Client first(running.port());
        first.take("ROBOT r1");
        EXPECT_EQ(second.ask("ROBOT r1"), "ERR 409 robot r1 is held by another client");
        if (politely)
            first.close();
        else
            first.vanish();
        Client third(running.port());
        third.connect();
        EXPECT_EQ(third.line(), "ISPACE 1");
        EXPECT_TRUE(comes(third, "ROBOT r1", "OK ROBOT r1 "));
    }
}

TEST(Server, RobotStopsWhenItsClientIsGone) {
    Running running;
    Client world(running.port()), next(running.port());
    world.take("WORLD");
    {
        Client robot(running.port());
        robot.take("ROBOT r2");
        EXPECT_EQ(robot.ask("SPEED 0.3"), "OK SPEED speed=0.3");
        EXPECT_EQ(step(world, 5).substr(0, 3), "OK ");
    }
    next.connect();
    next.line();
    ASSERT_TRUE(comes(next, "ROBOT r2", "OK "));
    EXPECT_EQ(step(world, 5).substr(0, 3), "OK ");
    EXPECT_NE(next.ask("STATUS").find(" speed=0.000 "), std::string::npos);
}

TEST(Server, AllReadersGetEachScanAndTheSameBytes) {
    constexpr int kScans = 300;
    Running running;
    Client world(running.port());
    world.take("WORLD");
    std::vector<std::unique_ptr<Client>> readers;
    for (int i = 0; i < 3; ++i) {
        readers.push_back(std::make_unique<Client>(running.port()));
        EXPECT_EQ(readers.back()->take("LASER l1").ask("STREAM"), "OK STREAM every=1");
    }
    EXPECT_EQ(step(world, kScans).substr(0, 3), "OK ");
    for (int seq = 1; seq <= kScans; ++seq) {
        const std::string first = readers[0]->line();
        ASSERT_NE(first.find(" seq=" + std::to_string(seq) + " "), std::string::npos) << first;
        ASSERT_EQ(readers[1]->line(), first);
        ASSERT_EQ(readers[2]->line(), first);
    }
    EXPECT_TRUE(readers[0]->quiet());
}

TEST(Server, BinaryScansKeepTheirLength) {
    Running running;
    Client world(running.port()), laser(running.port());
    world.take("WORLD");
    laser.take("LASER l1");
    EXPECT_EQ(laser.ask("BINARY on"), "OK BINARY on");
    EXPECT_EQ(laser.ask("STREAM"), "OK STREAM every=1");
    EXPECT_EQ(step(world, 3).substr(0, 3), "OK ");
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(laser.line().ends_with(" n=3 stream=1 bytes=12"));
        std::array<char, 12> ranges{};
        ASSERT_TRUE(laser.bytes(ranges.data(), ranges.size()));
        EXPECT_EQ(std::string_view(ranges.data() + 4, 4), std::string_view("\0\0\xe0\x40", 4));
    }
    EXPECT_EQ(laser.ask("STOP"), "OK STOP");
}

TEST(Server, PipelinedRequestsAreAnsweredInOrder) {
    constexpr int kRequests = 10000;
    Running running;
    Client client(running.port());
    client.take("ROBOT r1");
    std::string text;
    for (int i = 0; i < kRequests; ++i) text += "SPEED 0." + std::to_string(10000 + i) + "5\n";
    std::thread sender([&] { client.send(text); });
    for (int i = 0; i < kRequests; ++i)
        ASSERT_EQ(client.line(), "OK SPEED speed=0." + std::to_string(10000 + i) + "5");
    sender.join();
}

TEST(Server, StepKeepsLaterRequestsWaiting) {
    Running running;
    Client client(running.port());
    client.take("WORLD");
    client.send("STEP 20\nTIME\nSTEP\nTIME\n");
    EXPECT_EQ(client.line(), "OK STEP n=20 t=2.000");
    EXPECT_EQ(client.line(), "OK TIME t=2.000 steps=20");
    EXPECT_EQ(client.line(), "OK STEP n=1 t=2.100");
    EXPECT_EQ(client.line(), "OK TIME t=2.100 steps=21");
}

TEST(Server, HalfClosedClientGetsItsAnswers) {
    Running running;
    Client client(running.port());
    client.connect();
    client.send("WORLD\nSTEP 50\nTIME\nTIME");  // the last one is no whole line
    client.finishSending();
    EXPECT_EQ(client.rest(),
              "ISPACE 1\nOK WORLD t=0.000 dt=0.1 clock=step\nOK STEP n=50 t=5.000\n"
              "OK TIME t=5.000 steps=50\n");
}

TEST(Server, StopEndsTheRun) {
    Running running;
    Client client(running.port());
    client.take("WORLD");
    running.stop();
    EXPECT_EQ(client.rest(), "");
    EXPECT_EQ(running.server().clients(), 0U);
}

TEST(Server, StopEndsTheRunOfAnyClock) {
    for (const Clock::Kind kind : {Clock::Kind::Real, Clock::Kind::Fast}) {
        Running running({kind, 1});
        Client client(running.port());
        client.take("WORLD");
        running.stop();
        EXPECT_EQ(client.rest(), "");
    }
}

TEST(Server, ShutdownEndsTheRunAndAnswersWhoWaits) {
    Running running;
    Client first(running.port()), second(running.port()), idle(running.port());
    first.take("WORLD");
    second.take("WORLD");
    idle.take("LASER l1");
    first.send("STEP 1000000000\n");
    EXPECT_TRUE(comes(second, "TIME", "OK TIME t="));
    EXPECT_EQ(second.ask("SHUTDOWN").substr(0, 14), "OK SHUTDOWN t=");
    running.join();
    EXPECT_EQ(first.line().substr(0, 10), "OK STEP n=");
    for (Client* client : {&first, &second, &idle}) EXPECT_EQ(client->rest(), "");
}

TEST(Server, EndOfTheRunEndsMotionsAndSteps) {
    Running running;
    Client driver(running.port()), world(running.port());
    EXPECT_EQ(driver.take("ROBOT r1").ask("FORWARD 1").substr(0, 15), "OK FORWARD id=1");
    EXPECT_EQ(step(world.take("WORLD"), 10), "OK STEP n=10 t=1.000");
    running.server().stop();
    running.join();
    EXPECT_EQ(driver.rest(), "FAIL id=1 reason=stopped t=1.000\n");
    EXPECT_EQ(world.rest(), "");
}

TEST(Server, ResumeAnswersTheStepItCutsShort) {
    Running running({Clock::Kind::Real, 1});
    Client stepper(running.port()), other(running.port());
    EXPECT_EQ(stepper.take("WORLD").ask("PAUSE").substr(0, 8), "OK PAUSE");
    stepper.send("STEP 1000000000\nTIME\n");
    EXPECT_TRUE(comes(other.take("WORLD"), "TIME", "OK TIME t=1"));
    EXPECT_EQ(other.ask("RESUME").substr(0, 9), "OK RESUME");
    EXPECT_EQ(stepper.line().substr(0, 10), "OK STEP n=");
    EXPECT_EQ(stepper.line().substr(0, 7), "OK TIME");
}

TEST(Server, RealClockRunsByItself) {
    Running running({Clock::Kind::Real, 100});
    Client client(running.port());
    client.take("WORLD");
    EXPECT_TRUE(comes(client, "TIME", "OK TIME t=1"));
    EXPECT_EQ(client.ask("PAUSE").substr(0, 3), "OK ");
    const std::string time = client.ask("TIME");
    EXPECT_EQ(client.ask("TIME"), time);
    EXPECT_EQ(client.ask("RESUME").substr(0, 3), "OK ");
    EXPECT_TRUE(comes(client, "TIME", "OK TIME t=2"));
}

std::string parsed(const std::string& text) {
    const Endpoint endpoint = parseEndpoint(text);
    return endpoint.address + " " + std::to_string(endpoint.port);
}

std::string usage(const std::string& text) {
    try {
        parseEndpoint(text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(ParseEndpoint, ReadsLoopback) {
    EXPECT_EQ(parsed("127.0.0.1:0"), "127.0.0.1 0");
    EXPECT_EQ(parsed("127.1.2.3:65535"), "127.1.2.3 65535");
    EXPECT_EQ(parsed("localhost:8000"), "127.0.0.1 8000");
    EXPECT_EQ(parsed("[::1]:80"), "::1 80");
}

TEST(ParseEndpoint, HintsAtWhatIsMissing) {
    EXPECT_EQ(usage("8000"), "`8000` is no ADDR:PORT, did you mean 127.0.0.1:8000?");
    EXPECT_EQ(usage(":0"), "`:0` has no address, did you mean 127.0.0.1:0?");
    EXPECT_EQ(usage("localhost"), "`localhost` is no ADDR:PORT");
    EXPECT_EQ(usage(""), "`` is no ADDR:PORT");
    for (const std::string port :
         {"", "65536", "-1", "+1", "x", "80x", " 80", "1e3", "99999999999999999999"})
        EXPECT_EQ(usage("127.0.0.1:" + port),
                  "`127.0.0.1:" + port + "` has no port from 0 to 65535 behind the last colon");
}

TEST(ParseEndpoint, WantsANumericAddress) {
    for (const std::string host : {"example.com", "127.1", "::1", "[127.0.0.1]", "[localhost]",
                                   "1.2.3", "LOCALHOST", "[", "[]", "0x7f.0.0.1"})
        EXPECT_EQ(usage(host + ":80"),
                  "`" + host +
                      ":80`: wanted a numeric address or localhost before the port, like "
                      "127.0.0.1:8000 or [::1]:8000");
}

TEST(ParseEndpoint, TellsOtherMachinesApart) {
    for (const std::string host : {"0.0.0.0", "192.168.0.1", "126.255.255.255", "128.0.0.1", "[::]",
                                   "[fe80::1]", "[::ffff:127.0.0.1]"})
        EXPECT_FALSE(parseEndpoint(host + ":80").is_loopback) << host;
    for (const std::string host : {"127.0.0.1", "127.255.255.255", "localhost", "[::1]"})
        EXPECT_TRUE(parseEndpoint(host + ":80").is_loopback) << host;
}

}  // namespace server_test

}  // namespace ispace
