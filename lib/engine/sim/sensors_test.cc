// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/sensor_scheduler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "sim/world.h"
#include "sim/world_state.h"
#include "support/test_layout.h"

namespace ispace {
namespace sensors_test {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;
using testing::scene;

TEST(SceneResources, HasTheMeshThatItsSensorsNeed) {
    const auto has_mesh = [](const std::string& records) {
        const auto room = std::make_shared<const Scene>(scene("ispace size=8,6\n", records));
        return SceneResources(room, {}, {}).worlds.meshes().opaque;
    };
    EXPECT_FALSE(has_mesh("robot id=r1 at=0,0\nlaser at=1,1 beams=3\n"));
    EXPECT_TRUE(has_mesh("ranger at=1,1 pixels=4,4\n"));
    EXPECT_TRUE(has_mesh("tag at=1,1\n")) << "its echoes";
    EXPECT_TRUE(has_mesh("robot id=r1 model=pioneer-2dx at=0,0\n")) << "it has sonars";
}

TEST(SensorReader, ReadsAtTheFirstStepOfAPeriod) {
    for (const int rate : {10, 40, 7}) {
        const Scene room = scene("ispace size=8,6\n",
                                 "laser id=a at=0,0 beams=3 rate=" + std::to_string(rate) + "\n");
        for (const SimTime step : {milliseconds(5), milliseconds(3)}) {
            World world(room, step);
            ASSERT_EQ(world.latestReadings().size(), 1U);
            EXPECT_EQ(world.reading(0).seq, 0);
            EXPECT_EQ(world.reading(0).time, SimTime(0));
            std::int64_t next = 1;
            for (int i = 1; i <= 1500; ++i) {
                world.step();
                // Period k begins at k / rate seconds.
                const bool due = i * step.count() * rate >= next * 1'000'000'000;
                ASSERT_EQ(world.latestReadings().size(), due ? 1U : 0U) << i;
                if (!due) continue;
                const SensorReading& reading = world.reading(0);
                ASSERT_EQ(reading.seq, next);
                ASSERT_EQ(reading.time, i * step);
                ASSERT_EQ(reading.scan().time, ispace::seconds(i * step));
                ASSERT_EQ(reading.scan().frame, next);
                ++next;
            }
        }
    }
}

TEST(SensorReader, ALongStepTakesTheNewest) {
    const Scene room =
        scene("ispace size=8,6\n", "laser id=a at=0,0 rate=40\nlaser id=b at=1,0 rate=0.5\n");
    World world(room, seconds(1));
    EXPECT_EQ(world.latestReadings().size(), 2U);
    world.step();
    ASSERT_EQ(world.latestReadings().size(), 1U);
    EXPECT_EQ(world.latestReadings()[0], 0U);
    EXPECT_EQ(world.reading(0).seq, 40);
    world.step();
    ASSERT_EQ(world.latestReadings().size(), 2U);
    EXPECT_EQ(world.reading(0).seq, 80);
    EXPECT_EQ(world.reading(1).seq, 1);
    EXPECT_EQ(world.reading(1).time, seconds(2));
}

TEST(SensorReader, GoesWithItsRobotAndDoesNotSeeIt) {
    const Scene room = scene("ispace size=8,6\n",
                             "robot id=r1 at=-1,0\n"
                             "laser id=own on=r1 at=0.1,0 fov=180 step=90\n"
                             "laser id=wall at=-3,0 fov=180 step=90\n");
    World world(room, milliseconds(100));
    const auto ahead = [&](std::size_t laser) { return world.reading(laser).scan().ranges.at(1); };
    EXPECT_NEAR(ahead(0), 4.9, 1e-6);
    EXPECT_NEAR(ahead(1), 1.7, 1e-6);
    world.command(0, {Verb::Forward, 1});
    for (int i = 0; i < 60; ++i) world.step();
    EXPECT_NEAR(world.reading(0).pose.position.x, 0.1, 1e-9);
    EXPECT_EQ(world.reading(0).time, seconds(6));
    EXPECT_NEAR(ahead(0), 3.9, 1e-6);
    EXPECT_NEAR(ahead(1), 2.7, 1e-6);
    world.command(0, {Verb::Left, 90});
    for (int i = 0; i < 60; ++i) world.step();
    EXPECT_EQ(world.reading(0).pose.heading, Angle::degrees(90));
    EXPECT_NEAR(ahead(0), 2.9, 1e-6);
    // Scene and sensors() keep the start.
    EXPECT_NEAR(world.sensors()[0].pose.position.x, -0.9, 1e-12);
}

TEST(SensorReader, ATiltedOneOnARobotSeesThroughClearGlass) {
    for (const char* const glass : {"clear", "opaque"}) {
        const Scene room = scene(std::string("ispace size=8,6,2.5\ninside at=-3,0\n"
                                             "wall id=w from=1,-2.9 to=1,2.9 height=2.5\n"
                                             "window wall=w offset=2.9 size=3,0.1,2 sill=0.1 "
                                             "glass=") +
                                     glass + "\n",
                                 "robot id=r1 at=-2,0\n"
                                 "laser on=r1 at=0,0,1 tilt=3 range=20 fov=20 step=10\n"
                                 "laser on=r1 at=0,0,1 range=20 fov=20 step=10\n");
        World world(room, milliseconds(100));
        const double expected = glass == std::string("clear") ? 6 : 3;
        EXPECT_NEAR(world.reading(0).scan().ranges.at(1) * cos(Angle::degrees(3)), expected, 1e-5);
        EXPECT_NEAR(world.reading(1).scan().ranges.at(1), expected, 1e-5);
    }
}

}  // namespace sensors_test
}  // namespace ispace
