// SPDX-License-Identifier: GPL-3.0-or-later
// Passive infrared sensors of a running world.
#include <gtest/gtest.h>

#include <chrono>

#include "extensions/pirs/pir_state.h"
#include "extensions/pirs/pirs_test.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace::pirs {
namespace pir_run_test {

using std::chrono::milliseconds;

bool hasMotion(const World& world) {
    return std::get<AddedReading>(world.reading(0).value).as<PirState>().motion;
}

TEST(PirRun, HoldsItsOutputAfterThePersonStands) {
    const Scene room = testing::scene("ispace size=10,6\n",
                                      "pir id=s1 at=3,0,1.1 heading=180 hold=0.75\n"
                                      "human id=h1 at=-1,0 path=0,0\n");
    World world(room, milliseconds(50));
    int moving = 0, held = 0;
    bool was_on = false;
    for (int i = 0; i < 200; ++i) {
        world.step();
        if (world.latestReadings().empty()) continue;
        const bool moves = world.status(0).speed >= 0.1;
        moving += moves ? 1 : 0;
        if (moves) {
            EXPECT_TRUE(hasMotion(world)) << i;
        } else if (hasMotion(world)) {
            EXPECT_TRUE(was_on) << i;
            ++held;
        }
        was_on = hasMotion(world);
    }
    EXPECT_GT(moving, 5);
    // Readings each 0.1 s: seven are within the hold time after the last detection.
    EXPECT_EQ(held, 7);
    EXPECT_FALSE(was_on);
}

TEST(PirRun, ATurnOnTheSpotIsNoMotion) {
    const Scene room = testing::scene("ispace size=10,6\n",
                                      "pir id=s1 at=3,0,1.1 heading=180\nhuman id=h1 at=-1,0\n");
    World world(room, milliseconds(50));
    world.command(0, {.verb = Verb::Left, .value = 360});
    bool turned = false;
    for (int i = 0; i < 100; ++i) {
        world.step();
        turned = turned || world.status(0).rotspeed.radians() != 0;
        if (!world.latestReadings().empty()) {
            EXPECT_FALSE(hasMotion(world)) << i;
        }
    }
    EXPECT_TRUE(turned);
}

}  // namespace pir_run_test
}  // namespace ispace::pirs
