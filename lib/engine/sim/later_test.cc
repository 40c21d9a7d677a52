// SPDX-License-Identifier: GPL-3.0-or-later
// What is read after its step is as if it had been read in it.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace later_test {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::scene;

/// More lasers than are read together, that spin or do not, on robots and beside them.
Scene manyLasers() {
    std::string things = "tag id=t1 at=0,0,1\nultrasound id=u1 at=1,1,2.5 tilt=-90\n";
    for (int i = 0; i < 10; ++i) {
        const std::string id = std::to_string(i), x = std::to_string(i - 4.5);
        things += "robot id=r" + id + " at=" + x + ",-2 radius=0.2 walk=wander\n";
        things += "human id=h" + id + " at=" + x + ",2 walk=wander\n";
        things += "laser id=on" + id + " on=r" + id + " beams=31 rate=40 spin=40 range=8\n";
        for (int j = 0; j < 15; ++j) {
            const std::string name = id + "-" + std::to_string(j);
            things += "laser id=l" + name + " at=" + x + ",0 beams=9 range=8 rate=100\n";
        }
    }
    return scene("ispace size=12,8\n", things);
}

void expectSame(World& found, World& wanted, std::size_t sensor) {
    const SensorReading &a = found.reading(sensor), &b = wanted.reading(sensor);
    EXPECT_EQ(a.seq, b.seq) << sensor;
    EXPECT_EQ(a.time, b.time) << sensor;
    EXPECT_EQ(a.pose, b.pose) << sensor;
    if (const auto* scan = std::get_if<Scan>(&b.value)) {
        EXPECT_EQ(a.scan().ranges, scan->ranges) << sensor;
    }
}

TEST(Later, LasersAreReadAsInTheirStep) {
    const Scene room = manyLasers();
    const RunOptions options{.seed = 7, .sensor_noise = true};
    World whole(room, milliseconds(5), options), parts(room, milliseconds(5), options);
    const std::size_t count = whole.sensors().size();
    int stops = 0;
    for (std::size_t i = 1; i <= 200; ++i) {
        whole.step();
        parts.stepDeferred();
        ASSERT_TRUE(std::equal(whole.latestReadings().begin(), whole.latestReadings().end(),
                               parts.latestReadings().begin(), parts.latestReadings().end()));
        // One is asked for before the others, and what robots are told matters from the next step
        // on.
        expectSame(parts, whole, (17 * i) % count);
        for (World* world : {&whole, &parts})
            if (i % 50 == 0) world->command(i / 50, {Verb::Rotspeed, 30});
        // Some steps are read in turns, some by the next step, some as they are looked at.
        if (i % 3 == 0)
            while (!parts.readSome(steady_clock::now())) ++stops;
        if (i % 3 != 1)
            for (std::size_t k = 0; k < count; ++k) expectSame(parts, whole, k);
    }
    EXPECT_GT(stops, 10) << "not all at once";
}

TEST(Later, AChangedWorldHasWhatWasDue) {
    const Scene room = manyLasers();
    World whole(room, milliseconds(5)), parts(room, milliseconds(5));
    for (int i = 0; i < 10; ++i) {
        whole.step();
        parts.stepDeferred();
    }
    for (World* world : {&whole, &parts}) world->change(Scene(world->scene()));
    for (std::size_t k = 0; k < whole.sensors().size(); ++k) expectSame(parts, whole, k);
}

TEST(Later, APictureOutlivesItsWorld) {
    const Scene room =
        scene("ispace size=8,6\n",
              "camera id=c1 at=-3,0,1 pixels=40,30\n"
              "ranger id=d1 at=-3,1,1 pixels=40,30 range=0.3,9\nhuman id=h1 at=1,1\n");
    World still(room, milliseconds(5));
    World world(std::make_shared<const Scene>(room), milliseconds(5));
    const auto photograph = world.captureLater(0), sense = world.captureLater(1);
    world.restart(scene("ispace size=20,20\n", ""));
    EXPECT_TRUE(std::get<Photo>(photograph().value).rgb ==
                std::get<Photo>(still.captureNow(0).value).rgb);
    EXPECT_TRUE(std::get<DepthFrame>(sense().value).depths ==
                std::get<DepthFrame>(still.captureNow(1).value).depths);
}

TEST(Later, APictureShowsTheWorldAsItWasAskedOf) {
    const Scene room =
        scene("ispace size=8,6\n",
              "robot id=r1 at=0,0\ncamera id=c1 at=-3,0,1 pixels=40,30 rate=10\n"
              "ranger id=d1 at=-3,1,1 pixels=40,30 rate=10\nhuman id=h1 at=1,1 walk=wander\n");
    for (const std::size_t sensor : {std::size_t{0}, std::size_t{1}}) {
        World world(room, milliseconds(5)), still(room, milliseconds(5));
        for (World* each : {&world, &still}) {
            each->command(0, {Verb::Speed, 0.5});
            for (int i = 0; i < 300; ++i) each->step();
        }
        ASSERT_FALSE(world.isCaptured(sensor));
        const auto take = world.captureLater(sensor);
        // It goes on meanwhile, and somebody looks at it.
        SensorReading later;
        std::thread other([&] { later = take(); });
        for (int i = 0; i < 30; ++i) world.step();
        const SensorReading now = world.captureNow(sensor);
        other.join();
        const SensorReading& wanted = still.captureNow(sensor);
        EXPECT_EQ(later.seq, wanted.seq);
        EXPECT_EQ(later.time, wanted.time);
        EXPECT_EQ(later.pose, wanted.pose);
        EXPECT_EQ(now.seq, wanted.seq + 1);
        if (sensor == 0) {
            const auto& picture = std::get<Photo>(wanted.value).rgb;
            EXPECT_TRUE(std::get<Photo>(later.value).rgb == picture);
            EXPECT_FALSE(std::get<Photo>(now.value).rgb == picture);
        } else {
            const auto& depths = std::get<DepthFrame>(wanted.value).depths;
            EXPECT_TRUE(std::get<DepthFrame>(later.value).depths == depths);
            EXPECT_FALSE(std::get<DepthFrame>(now.value).depths == depths);
        }
        for (int i = 0; i < 20; ++i) world.step();
        world.storeCapture(sensor, later);
        EXPECT_EQ(world.reading(sensor).seq, wanted.seq);
        EXPECT_FALSE(world.isCaptured(sensor)) << "there is a newer period";
    }
}

}  // namespace later_test
}  // namespace ispace
