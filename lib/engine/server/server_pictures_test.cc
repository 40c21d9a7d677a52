// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures take long: others are served meanwhile, and a run by steps does not change for it.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/number.h"
#include "support/test_client.h"

namespace ispace {
namespace server_pictures_test {

using testing::Client;
using testing::Running;
using testing::step;

const std::string kBig = "camera id=big at=-3,0,1 pixels=1200,900 rate=10\n";
const std::string kSmall =
    "camera id=c1 at=-3,0,1 pixels=16,12 rate=5\nranger id=d1 at=-3,1,1 pixels=16,12 rate=5\n";

/// The line of a SCAN, and how many bytes came behind it.
std::string frame(Client& client, std::string& bytes) {
    std::string line = client.line();
    const std::size_t key = line.find(" bytes=");
    if (key == std::string::npos) return line;
    const auto size = parseInteger(std::string_view(line).substr(key + 7));
    bytes.resize(static_cast<std::size_t>(size.value()));
    client.bytes(bytes.data(), bytes.size());
    return line;
}

TEST(ServerPictures, OthersAreServedMeanwhile) {
    Running running({Clock::Kind::Step, 1}, {}, kBig);
    Client viewer(running.port()), robot(running.port()), world(running.port());
    viewer.take("SENSOR big");
    robot.take("ROBOT r1");
    world.take("WORLD");
    ASSERT_TRUE(viewer.send("SCAN\nFORMAT rgb\n"));
    // Requests of others are answered while it is being made, and what they ask of the world comes
    // after it.
    EXPECT_EQ(robot.ask("SPEED 1").substr(0, 8), "OK SPEED");
    EXPECT_EQ(robot.ask("STATUS").substr(0, 9), "OK STATUS");
    EXPECT_TRUE(viewer.quiet()) << "a picture of a million pixels takes longer";
    EXPECT_EQ(step(world, 3), "OK STEP n=3 t=0.300");
    std::string bytes;
    EXPECT_EQ(frame(viewer, bytes).substr(0, 22), "SCAN big t=0.000 seq=0");
    EXPECT_EQ(bytes.substr(1, 3), "PNG");
    EXPECT_EQ(viewer.line(), "OK FORMAT rgb");
}

TEST(ServerPictures, ClientsShareThem) {
    Running running({Clock::Kind::Step, 1}, {}, kBig);
    Client a(running.port()), b(running.port()), c(running.port());
    for (Client* client : {&a, &b, &c}) client->take("SENSOR big");
    EXPECT_EQ(c.ask("FORMAT rgb"), "OK FORMAT rgb");
    for (Client* client : {&a, &b, &c}) ASSERT_TRUE(client->send("SCAN\n"));
    std::string first, same, raw;
    const std::string line = frame(a, first);
    EXPECT_EQ(frame(b, same), line);
    EXPECT_TRUE(first == same);
    frame(c, raw);
    EXPECT_EQ(raw.size(), 3U * 1200 * 900);
}

TEST(ServerPictures, AStreamBySteps) {
    // Each frame is of its step, and what the client asks for comes after it.
    std::vector<std::string> runs;
    for (int run = 0; run < 2; ++run) {
        Running running({Clock::Kind::Step, 1}, {}, kSmall);
        Client camera(running.port()), ranger(running.port()), robot(running.port()),
            world(running.port());
        camera.take("SENSOR c1");
        ranger.take("SENSOR d1");
        robot.take("ROBOT r1");
        world.take("WORLD");
        for (Client* client : {&camera, &ranger})
            EXPECT_EQ(client->ask("STREAM"), "OK STREAM every=1");
        robot.ask("SPEED 0.4");
        EXPECT_EQ(step(world, 10), "OK STEP n=10 t=1.000");
        std::string all;
        for (Client* client : {&camera, &ranger}) {
            ASSERT_TRUE(client->send("STOP\n"));
            for (int k = 1; k <= 5; ++k) {
                std::string bytes;
                const std::string line = frame(*client, bytes);
                EXPECT_NE(line.find(" seq=" + std::to_string(k) + " "), std::string::npos) << line;
                all += line + bytes;
            }
            EXPECT_EQ(client->line(), "OK STOP");
        }
        runs.push_back(all);
    }
    EXPECT_TRUE(runs[0] == runs[1]);
}

TEST(ServerPictures, AClientGoesMeanwhile) {
    Running running({Clock::Kind::Step, 1}, {}, kBig);
    Client viewer(running.port()), world(running.port());
    viewer.take("SENSOR big");
    world.take("WORLD");
    ASSERT_TRUE(viewer.send("SCAN\n"));
    std::string bytes;
    EXPECT_EQ(frame(viewer, bytes).substr(0, 14), "SCAN big t=0.0");
    // A client that goes while its picture is made takes nothing with it.
    Client another(running.port());
    another.take("SENSOR big");
    EXPECT_EQ(step(world, 1), "OK STEP n=1 t=0.100");
    ASSERT_TRUE(another.send("SCAN\n"));
    another.vanish();
    EXPECT_EQ(step(world, 1), "OK STEP n=1 t=0.200");
    ASSERT_TRUE(viewer.send("SCAN\n"));
    EXPECT_EQ(frame(viewer, bytes).substr(0, 22), "SCAN big t=0.200 seq=2");
}

TEST(ServerPictures, AtTheEndOfARun) {
    Running running({Clock::Kind::Step, 1}, {}, kBig);
    Client viewer(running.port()), world(running.port());
    viewer.take("SENSOR big");
    world.take("WORLD");
    ASSERT_TRUE(viewer.send("SCAN\n"));
    for (int i = 0; i < 3; ++i) EXPECT_EQ(world.ask("TIME").substr(0, 7), "OK TIME");
    EXPECT_EQ(world.ask("SHUTDOWN"), "OK SHUTDOWN t=0.000");
    std::string bytes;
    EXPECT_EQ(frame(viewer, bytes).substr(0, 14), "SCAN big t=0.0");
    EXPECT_EQ(bytes.substr(1, 3), "PNG");
}

}  // namespace server_pictures_test
}  // namespace ispace
