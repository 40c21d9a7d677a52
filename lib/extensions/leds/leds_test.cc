// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/leds/led.h"
#include "record/text.h"
#include "scene/bodies.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"
#include "scene/scene.h"
#include "sense/photo.h"
#include "sense/selection.h"
#include "sim/world.h"

namespace ispace::leds {
namespace leds_test {

using std::chrono::milliseconds;

Scene sceneOf(const std::string& records) {
    static const bool added = [] {
        addSceneSchemas(ledSchemas());
        addLeds();
        return true;
    }();
    EXPECT_TRUE(added);
    return makeScene(readRecordText("#env 1\nispace size=8,6,3 ceiling=yes\n" + records, "room.env",
                                    sceneSchemas()),
                     nullptr, shippedDevices());
}

const PlacedRecord& placedOf(const Scene& scene, const std::string& id) {
    for (const PlacedRecord& placed : scene.placed)
        if (scene.ids[placed.record] == id) return placed;
    throw std::logic_error("no such record");
}

TEST(Led, StandsOnItsCarrier) {
    const Scene scene = sceneOf(
        "robot id=r at=1,1 heading=90\ntable id=t at=-2,0 height=0.7\nled id=a of=r at=0.2,0,0.4\n"
        "led id=b of=t at=0,0,0.1\nled id=c at=0,1,2\n");
    EXPECT_NEAR(placedOf(scene, "a").pose.position.x, 1, 1e-12);
    EXPECT_NEAR(placedOf(scene, "a").pose.position.y, 1.2, 1e-12);
    ASSERT_TRUE(placedOf(scene, "a").mount);
    EXPECT_NEAR(placedOf(scene, "b").pose.position.z, 0.8, 1e-12);
    EXPECT_NEAR(placedOf(scene, "c").pose.position.z, 2, 1e-12);
    EXPECT_FALSE(placedOf(scene, "c").mount);
    EXPECT_FALSE(bodyOf(scene, placedOf(scene, "c")).empty());
    try {
        sceneOf("led id=a of=q\n");
        FAIL() << "no carrier";
    } catch (const FormatError& error) {
        EXPECT_EQ(error.diagnostics().front().message, "`of`: nothing has the id `q`");
    }
}

TEST(Led, HasStates) {
    const Scene scene = sceneOf("led id=a on=yes color=1,0,0\n");
    const std::vector<RoomState> states = roomStates(scene);
    EXPECT_NE(std::find(states.begin(), states.end(), RoomState{"a", "on", "1"}), states.end());
    EXPECT_NE(std::find(states.begin(), states.end(), RoomState{"a", "color", "1,0,0"}),
              states.end());
    EXPECT_TRUE(ledBody(scene.records.back()).glow);
    EXPECT_FALSE(ledBody(sceneOf("led id=a\n").records.back()).glow);
}

constexpr int kColumns = 64, kRows = 48;

/// The mean red, green and blue of the middle of a picture, 0 to 255.
std::vector<double> middleOf(World& world) {
    const SensorReading& reading = world.captureNow(0);
    const Photo& photo = std::get<Photo>(reading.value);
    std::vector<double> sum(3, 0);
    int count = 0;
    for (int y = kRows / 2 - 2; y < kRows / 2 + 2; ++y)
        for (int x = kColumns / 2 - 2; x < kColumns / 2 + 2; ++x, ++count)
            for (std::size_t k = 0; k < 3; ++k)
                sum[k] += photo.rgb[3 * static_cast<std::size_t>(y * kColumns + x) + k];
    for (double& part : sum) part /= count;
    return sum;
}

const std::string kCamera = "camera id=eye at=-2,0,0.5 pixels=64,48 fov=20\n";

/// The camera sees it in its colour, and dark while it is off.
TEST(Led, ShinesInPictures) {
    const auto picture = [](const std::string& led) {
        const Scene scene = sceneOf(kCamera + led);
        World world(scene, milliseconds(10));
        return middleOf(world);
    };
    const std::string led = "led id=a at=0,0,0.5 size=0.2 ";
    const auto dark = picture(led), red = picture(led + "on=yes color=1,0,0"),
               blue = picture(led + "on=yes color=0,0,1");
    EXPECT_GT(red[0], dark[0] + 100);
    EXPECT_LT(red[2], 60);
    EXPECT_GT(blue[2], dark[2] + 100);
    EXPECT_LT(blue[0], 60);
}

/// It goes with its robot.
TEST(Led, GoesWithItsRobot) {
    const Scene scene = sceneOf(kCamera +
                                "robot id=r at=0,1.5 heading=-90\n"
                                "led id=a of=r at=0,0,0.5 size=0.2 on=yes color=1,0,0\n");
    World world(scene, milliseconds(10));
    const auto redness = [&world] {
        const std::vector<double> color = middleOf(world);
        return color[0] - color[2];
    };
    EXPECT_LT(redness(), 60) << "the wall";
    world.command(*world.moverNamed("r"), {.verb = Verb::Forward, .value = 1.5});
    for (int i = 0; i < 1000; ++i) world.step();
    EXPECT_GT(redness(), 150);
}

}  // namespace leds_test
}  // namespace ispace::leds
