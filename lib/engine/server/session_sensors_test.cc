// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "base/message.h"
#include "raster/codec.h"
#include "support/test_talk.h"

namespace ispace {
namespace session_sensors_test {

using testing::kLong;

/// A room in which a robot drives away from a camera, past a ranger. Steps of 0.1 s.
struct SensorTalk {
    SensorTalk()
        : scene(testing::scene("ispace size=8,6\n",
                               "robot id=r1 model=pioneer-2dx at=0,0\n"
                               "camera id=c1 at=-3,0,1 pixels=8,6 rate=5\n"
                               "ranger id=d1 at=-1,0,0.1 pixels=4,2 fov=40,20 rate=2.5 "
                               "projection=spherical\n"
                               "laser id=l1 at=-3,-2 fov=4 step=2 range=0.1,7.002\n"
                               "mat id=m1 at=1,0 size=0.2,0.2 rate=5\n")),
          world(scene, std::chrono::milliseconds(100)),
          simulation(world, {}, {Clock::Kind::Step, 1}, {}),
          state(simulation) {
        simulation.onStep([this] {
            for (Session& client : clients) client.stepped();
        });
    }
    Session& client(std::string_view role) {
        Session& added = clients.emplace_back(state);
        ask(added, role);
        return added;
    }
    static std::string ask(Session& client, std::string_view request) {
        client.request(request);
        return client.take();
    }
    void step(std::int64_t count) {
        simulation.allow(count);
        simulation.run(WallTime{}, kLong);
    }
    /// The answer to a client until its capture is complete.
    std::string settle(Session& client) {
        std::string text = client.take();
        while (client.waiting()) {
            std::this_thread::yield();
            state.collect();
            client.proceed();
            text += client.take();
        }
        return text;
    }

    Scene scene;
    World world;
    Simulation simulation;
    ServerState state;
    std::list<Session> clients;
};

std::string lineOf(const std::string& reply) { return reply.substr(0, reply.find('\n')); }
std::string bytesOf(const std::string& reply) { return reply.substr(reply.find('\n') + 1); }

TEST(SessionSensors, ADepthFrameIsLittleEndian) {
    SensorTalk talk;
    Session& client = talk.client("SENSOR d1");
    const std::string reply = talk.ask(client, "SCAN");
    EXPECT_EQ(lineOf(reply),
              "SCAN d1 t=0.000 seq=0 pose=-1.000,0.000,0.100,0.000,0.000,0.000 format=depth32 "
              "width=4 height=2 bytes=32");
    const std::string bytes = bytesOf(reply);
    ASSERT_EQ(bytes.size(), 32U);
    const std::vector<float>& depths = std::get<DepthFrame>(talk.world.reading(1).value).depths;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        std::uint32_t bits = 0;
        for (std::size_t k = 4; k-- > 0;)
            bits = bits << 8U | static_cast<std::uint8_t>(bytes[4 * i + k]);
        EXPECT_EQ(std::bit_cast<float>(bits), depths[i]);
    }
    // The robot's rear is 0.74 m away; the lower row meets the floor.
    EXPECT_NEAR(
        depths[1],
        0.74 / std::cos(Angle::degrees(5).radians()) / std::cos(Angle::degrees(5).radians()), 0.01);
    talk.ask(client, "FORMAT depth16");
    const std::string small = bytesOf(talk.ask(client, "SCAN"));
    ASSERT_EQ(small.size(), 16U);
    EXPECT_EQ(static_cast<std::uint8_t>(small[2]) + 256 * static_cast<std::uint8_t>(small[3]),
              std::lround(depths[1] * 1000));
    talk.ask(client, "FORMAT cloud");
    EXPECT_EQ(bytesOf(talk.ask(client, "SCAN")).size(), 4U * 2 * 3 * 4);
}

TEST(SessionSensors, APictureIsAFile) {
    SensorTalk talk;
    Session& client = talk.client("SENSOR c1");
    const std::string png = bytesOf(talk.ask(client, "SCAN"));
    const auto& photo = std::get<Photo>(talk.world.reading(0).value);
    EXPECT_EQ(png, pngOfRgb(8, 6, photo.rgb));
    EXPECT_EQ(talk.ask(client, "BINARY off"), "OK BINARY off\n");
    const std::string text = talk.ask(client, "SCAN");
    EXPECT_TRUE(text.ends_with(" base64=" + base64(png) + "\n")) << text;
    EXPECT_EQ(talk.ask(client, "FORMAT rgb"), "OK FORMAT rgb\n");
    EXPECT_TRUE(
        talk.ask(client, "SCAN")
            .ends_with(" format=rgb width=8 height=6 base64=" +
                       base64({reinterpret_cast<const char*>(photo.rgb.data()), photo.rgb.size()}) +
                       "\n"));
}

TEST(SessionSensors, APictureShowsTheWorldAsItIs) {
    SensorTalk talk;
    Session& client = talk.client("SENSOR c1");
    talk.ask(client, "FORMAT rgb");
    const std::string before = talk.ask(client, "SCAN");
    talk.step(4);
    // Nothing moved: the same picture at another time.
    const std::string same = talk.ask(client, "SCAN");
    EXPECT_NE(lineOf(before), lineOf(same));
    EXPECT_EQ(bytesOf(before), bytesOf(same));
    talk.world.command(0, {Verb::Left, 90});
    talk.step(40);
    const std::string after = talk.ask(client, "SCAN");
    EXPECT_NE(bytesOf(before), bytesOf(after));
    // As a scene that has the robot there.
    const Scene turned = testing::scene("ispace size=8,6\n",
                                        "robot id=r1 model=pioneer-2dx at=0,0 heading=90\n"
                                        "camera id=c1 at=-3,0,1 pixels=8,6 rate=5\n");
    const Photo photo =
        Photographer(turned, {.seed = 0}).take(turned.sensors[0], turned.sensors[0].pose, 0);
    EXPECT_EQ(bytesOf(after),
              std::string(reinterpret_cast<const char*>(photo.rgb.data()), photo.rgb.size()));
}

TEST(SessionSensors, AStreamTakesPicturesWhenDue) {
    SensorTalk talk;
    Session& client = talk.client("SENSOR c1");
    EXPECT_EQ(talk.ask(client, "STREAM every=2"), "OK STREAM every=2\n");
    std::vector<std::string> heads;
    for (int i = 0; i < 10; ++i) {
        talk.step(1);
        if (const auto scan = client.takeScan()) heads.push_back(scan->substr(0, 23));
    }
    EXPECT_EQ(heads,
              (std::vector<std::string>{"SCAN c1 t=0.400 seq=2 p", "SCAN c1 t=0.800 seq=4 p"}));
    EXPECT_EQ(talk.ask(client, "STOP"), "OK STOP\n");
    // The last reader of pictures leaves.
    const std::int64_t last = talk.world.reading(0).seq;
    talk.step(20);
    EXPECT_EQ(talk.world.reading(0).seq, last);
}

TEST(SessionSensors, ASlowReaderGetsTheNewestPictureAndCostsNoOthers) {
    SensorTalk talk;
    Session& client = talk.client("SENSOR c1");
    talk.ask(client, "STREAM");
    talk.step(2);
    EXPECT_EQ(talk.world.reading(0).seq, 1);
    talk.step(20);
    EXPECT_EQ(talk.world.reading(0).seq, 1);
    EXPECT_TRUE(testing::streamed(client).starts_with("SCAN c1 t=2.200 seq=11 "));
    EXPECT_EQ(client.takeScan(), nullptr);
}

TEST(SessionSensors, ASlowReaderGetsNoOtherPicturesThanItAskedFor) {
    SensorTalk talk;
    Session& client = talk.client("SENSOR c1");
    talk.ask(client, "STREAM every=3");
    talk.step(6);
    talk.step(17);  // to the middle of a period
    EXPECT_EQ(client.takeScan(), nullptr) << "the unread one is late, and the next one not due";
    talk.step(2);
    EXPECT_TRUE(testing::streamed(client).starts_with("SCAN c1 t=2.400 seq=12 "));
}

/// A client that has left a picture unread for so long that it is stale. Frames are made aside.
struct SlowTalk : SensorTalk {
    SlowTalk() : slow(client("SENSOR c1")) {
        state.startBackground([] {}, nullptr);
        ask(slow, "STREAM");
        step(2);
        EXPECT_EQ(settle(slow), "");
        EXPECT_GT(slow.scanBytes(), 0U);
        step(20);
    }
    ~SlowTalk() { state.stopBackground(); }
    SlowTalk(const SlowTalk&) = delete;
    SlowTalk& operator=(const SlowTalk&) = delete;

    Session& slow;
};

TEST(SessionSensors, ARequestWaitsForTheFrameBeforeIt) {
    SlowTalk talk;
    EXPECT_EQ(talk.ask(talk.slow, "SCAN"), "") << "nobody else waits";
    EXPECT_TRUE(talk.slow.waiting());
    // Frames that come due meanwhile are not taken.
    talk.step(4);
    const std::string text = talk.settle(talk.slow);
    EXPECT_EQ(lineOf(text).substr(0, 24), "SCAN c1 t=2.200 seq=11 p");
    EXPECT_NE(lineOf(text).find(" stream=1 "), std::string::npos);
    const std::size_t second = text.find("SCAN c1 ", 1);
    ASSERT_NE(second, std::string::npos);
    EXPECT_EQ(text.substr(second, 24), "SCAN c1 t=2.600 seq=13 p");
    EXPECT_EQ(text.find("SCAN c1 ", second + 1), std::string::npos);
    EXPECT_EQ(talk.slow.takeScan(), nullptr);
    // The stream goes on.
    talk.step(2);
    EXPECT_EQ(talk.settle(talk.slow), "");
    EXPECT_TRUE(testing::streamed(talk.slow).starts_with("SCAN c1 t=2.800 seq=14 "));
}

TEST(SessionSensors, AStreamStopsAfterTheFrameBeforeThat) {
    SlowTalk talk;
    EXPECT_EQ(talk.ask(talk.slow, "STOP"), "");
    const std::string text = talk.settle(talk.slow);
    EXPECT_TRUE(text.starts_with("SCAN c1 t=2.200 seq=11 "));
    EXPECT_TRUE(text.ends_with("OK STOP\n"));
    talk.step(10);
    EXPECT_EQ(talk.slow.takeScan(), nullptr);
}

TEST(SessionSensors, TheRunEndsBeforeTheFrameIsMade) {
    SlowTalk talk;
    EXPECT_EQ(talk.ask(talk.slow, "SCAN"), "");
    talk.slow.finish();
    const std::string text = talk.slow.take();
    EXPECT_TRUE(text.starts_with("SCAN c1 t=2.200 seq=11 "));
    EXPECT_NE(text.find("SCAN c1 t=2.200 seq=11 ", 1), std::string::npos);
    EXPECT_FALSE(talk.slow.waiting());
}

TEST(SessionSensors, TheSensorGoesBeforeTheFrameIsMade) {
    SlowTalk talk;
    EXPECT_EQ(talk.ask(talk.slow, "SCAN"), "");
    talk.world.change(testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n"));
    EXPECT_EQ(talk.settle(talk.slow),
              "EVENT gone t=2.200 id=c1\nERR 404 c1 is no more: open another connection\n");
}

TEST(SessionSensors, ALaserIsReadAsByTheRoleLaser) {
    SensorTalk talk;
    Session& laser = talk.client("LASER l1");
    Session& sensor = talk.client("SENSOR l1");
    EXPECT_EQ(talk.ask(laser, "SCAN"), talk.ask(sensor, "SCAN"));
    talk.ask(laser, "BINARY on");
    talk.ask(sensor, "BINARY on");
    EXPECT_EQ(talk.ask(laser, "SCAN"), talk.ask(sensor, "SCAN"));
}

TEST(SessionSensors, ASensorOnARobotTellsItsPoseThere) {
    const Scene scene = testing::scene("ispace size=8,6\n",
                                       "robot id=r1 model=pioneer-2dx at=1,1 heading=90\n"
                                       "laser id=l1 on=r1 at=0.1,-0.05,0.3 heading=180 tilt=-10 "
                                       "step=90\nlaser id=l2 at=0,0 step=90\n");
    World world(scene, std::chrono::milliseconds(100));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    ServerState state(simulation);
    Session laser(state), sensor(state), in_room(state);
    EXPECT_TRUE(SensorTalk::ask(laser, "LASER l1").ends_with(" mount=0.1,-0.05,0.3,180,-10,0\n"));
    EXPECT_TRUE(SensorTalk::ask(sensor, "SENSOR l1").ends_with(" mount=0.1,-0.05,0.3,180,-10,0\n"));
    EXPECT_EQ(SensorTalk::ask(in_room, "LASER l2").find("mount="), std::string::npos);
}

TEST(SessionSensors, AMatIsStreamed) {
    SensorTalk talk;
    Session& client = talk.client("SENSOR m1");
    talk.ask(client, "STREAM");
    talk.world.command(0, {Verb::Forward, 1});
    std::string all;
    for (int i = 0; i < 60; ++i) {
        talk.step(1);
        all += testing::streamed(client);
    }
    EXPECT_NE(all.find(" n=0 on= stream=1\n"), std::string::npos);
    EXPECT_TRUE(all.ends_with("SCAN m1 t=6.000 seq=30 n=1 on=r1 stream=1\n")) << all;
}

}  // namespace session_sensors_test
}  // namespace ispace
