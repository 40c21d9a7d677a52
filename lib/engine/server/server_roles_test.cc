// SPDX-License-Identifier: GPL-3.0-or-later
// Slow, broken and dying clients in the roles SENSOR and PERSON, and clients that change the world.
#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "support/test_client.h"
#include "support/test_source.h"

namespace ispace {
namespace server_roles_test {

using testing::Client;
using testing::comes;
using testing::Running;
using testing::soon;
using testing::step;

constexpr const char* kMore =
    "human id=h1 at=-2,2\n"
    "camera id=c1 at=3.5,-2.5,2 heading=140 tilt=-20 pixels=320,240 fov=70 rate=10\n"
    "ranger id=d1 at=-3.5,2.5,1 heading=-40 pixels=16,12 fov=60,45 rate=10\n";

ServerLimits changing() {
    ServerLimits limits;
    limits.source = std::make_shared<testing::TextSource>(std::map<std::string, std::string>{});
    return limits;
}

struct Hall : Running {
    Hall() : Running({Clock::Kind::Step, 1}, changing(), kMore) {}
};

long numberOf(const std::string& line, const std::string& key) {
    const std::size_t at = line.find(" " + key + "=");
    EXPECT_NE(at, std::string::npos) << line;
    return at == std::string::npos ? -1 : std::stol(line.substr(at + key.size() + 2));
}

TEST(ServerRoles, PicturesThatNobodyReadsDelayNobody) {
    constexpr int kSteps = 80;
    Hall hall;
    Client world(hall.port()), slow(hall.port(), 2048), quick(hall.port());
    world.take("WORLD");
    EXPECT_EQ(slow.take("SENSOR c1").ask("FORMAT rgb").substr(0, 9), "OK FORMAT");
    EXPECT_EQ(slow.ask("STREAM"), "OK STREAM every=1");
    quick.take("PERSON h1");
    // Some 18 MB of pictures.
    for (int i = 1; i <= kSteps; ++i) {
        ASSERT_EQ(step(world, 1).substr(0, 11), "OK STEP n=1");
        ASSERT_EQ(quick.ask("STATUS").substr(0, 9), "OK STATUS");
    }
    slow.send("STOP\n");
    long last = -1;
    int count = 0;
    for (std::string line = slow.line(); line != "OK STOP"; line = slow.line(), ++count) {
        ASSERT_TRUE(line.starts_with("SCAN c1 ")) << line;
        ASSERT_GT(numberOf(line, "seq"), last);
        last = numberOf(line, "seq");
        std::vector<char> picture(static_cast<std::size_t>(numberOf(line, "bytes")));
        ASSERT_EQ(picture.size(), 320U * 240 * 3);
        ASSERT_TRUE(slow.bytes(picture.data(), picture.size()));
    }
    EXPECT_EQ(last, kSteps) << "the newest";
    EXPECT_LT(count, kSteps) << "those between are not even taken";
}

TEST(ServerRoles, APersonWhoseClientDiesStandsAndIsFree) {
    Hall hall;
    Client world(hall.port()), next(hall.port());
    world.take("WORLD");
    {
        Client gone(hall.port());
        gone.take("PERSON h1");
        EXPECT_EQ(gone.ask("SPEED 1").substr(0, 8), "OK SPEED");
        EXPECT_EQ(step(world, 5).substr(0, 7), "OK STEP");
        EXPECT_EQ(gone.ask("STATUS").find(" speed=0.000"), std::string::npos);
        gone.vanish();
    }
    next.connect();
    EXPECT_EQ(next.line(), "ISPACE 1");
    EXPECT_TRUE(comes(next, "PERSON h1", "OK PERSON h1 "));
    EXPECT_EQ(step(world, 20).substr(0, 7), "OK STEP");
    EXPECT_NE(next.ask("STATUS").find(" speed=0.000"), std::string::npos);
}

TEST(ServerRoles, GarbageIsRefusedInEveryRole) {
    Hall hall;
    const std::string none("\0\x01\xff", 3);
    const std::vector<std::pair<std::string, std::vector<std::string>>> roles = {
        {"SENSOR c1",
         {"FORMAT " + none, "FORMAT bmp", "BINARY maybe", "STREAM every=0", "STREAM every=-1",
          "STREAM every=99999999999999999999", "STREAM " + none, "SCAN " + none, "FORWARD 1"}},
        {"SENSOR d1", {"FORMAT jpeg", "FORMAT ", "BINARY \xff", "STREAM every=nan", none}},
        {"PERSON h1",
         {"SPEED nan", "SPEED 1e309", "SPEED " + none, "PATH nan,inf", "PATH 1", "PATH 1,2;",
          "PATH 1,2 loop=maybe", "FORWARD -1", "SIDESPEED 1e9", "SCAN l1", none}},
        {"WORLD",
         {"ADD " + none,
          "ADD robot at=nan,1",
          "ADD robot id=" + none,
          "ADD cube size=1e400",
          "ADD " + std::string(4000, 'x'),
          "SET " + none,
          "SET r1",
          "SET r1.at=1",
          "SET r1.at=" + none,
          "SET *.*.*",
          "SET ****.at=1,1",
          "DELETE " + none,
          "DELETE nobody",
          "LOAD ../../etc/passwd",
          "LOAD " + none,
          "EVENTS " + none,
          "MARK \x1b[2J",
          "STEP -1",
          "STEP 1e9",
          none}}};
    Client world(hall.port());
    world.take("WORLD");
    const std::string poses = world.ask("POSES"), list = world.ask("LIST");
    for (const auto& [role, requests] : roles) {
        Client client(hall.port());
        client.take(role);
        for (const std::string& request : requests)
            EXPECT_EQ(client.ask(request).substr(0, 5), "ERR 4") << role << ": " << request;
        EXPECT_EQ(client.ask("QUIT"), "OK QUIT");
    }
    EXPECT_EQ(world.ask("POSES"), poses);
    EXPECT_EQ(world.ask("LIST"), list);
}

TEST(ServerRoles, OneByteAtATime) {
    Hall hall;
    const auto all = [&](const std::string& text) {
        Client client(hall.port());
        client.connect();
        for (const char c : text) EXPECT_TRUE(client.send(std::string_view(&c, 1)));
        return client.rest();
    };
    EXPECT_EQ(all("WORLD\nADD human id=h9 at=1,-1\r\nSET h9.at=2,-2\nDELETE h9\nQUIT\n"),
              "ISPACE 1\nOK WORLD t=0.000 dt=0.1 clock=step\nOK ADD id=h9 t=0.000\n"
              "OK SET t=0.000\nOK DELETE t=0.000\nOK QUIT\n");
    const std::string frame = all("SENSOR d1\nFORMAT depth16\nSCAN\nQUIT\n");
    EXPECT_NE(frame.find(" bytes=384\n"), std::string::npos);
    EXPECT_TRUE(frame.ends_with("OK QUIT\n"));
}

TEST(ServerRoles, ChangesThatNobodyWaitsForAreBounded) {
    constexpr int kChanges = 200;
    Hall hall;
    Client slow(hall.port(), 2048), quick(hall.port()), world(hall.port());
    slow.take("WORLD");
    world.take("WORLD");
    quick.take("ROBOT r1");
    std::string text;
    for (int i = 0; i < kChanges; ++i)
        text += "SET r2.at=2," + std::to_string(1 + (i % 2) * 0.5) + "\n";
    ASSERT_TRUE(slow.send(text));
    for (int i = 0; i < 200; ++i) ASSERT_EQ(quick.ask("STATUS").substr(0, 9), "OK STATUS");
    EXPECT_EQ(step(world, 1).substr(0, 7), "OK STEP");
    for (int i = 0; i < kChanges; ++i) ASSERT_EQ(slow.line().substr(0, 6), "OK SET") << i;
}

TEST(ServerRoles, WhoDiesWithChangesOnTheWayLeavesAWorld) {
    Hall hall;
    for (int i = 0; i < 5; ++i) {
        Client gone(hall.port());
        gone.take("WORLD");
        std::string text;
        for (int k = 0; k < 20; ++k)
            text += "ADD cube id=x" + std::to_string(20 * i + k) + " at=0,-2 size=0.1,0.1,0.1\n";
        gone.send(text);
        gone.vanish();
    }
    Client world(hall.port());
    EXPECT_TRUE(soon([&] { return hall.server().clients() == 0; }));
    world.take("WORLD");
    EXPECT_EQ(world.ask("ADD cube id=last at=0,-2 size=0.1,0.1,0.1").substr(0, 14),
              "OK ADD id=last");
    EXPECT_EQ(world.ask("DELETE last").substr(0, 9), "OK DELETE");
    EXPECT_EQ(step(world, 1).substr(0, 7), "OK STEP");
}

}  // namespace server_roles_test
}  // namespace ispace
