// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "cli/common_options.h"
#include "extensions/curtains/curtains_test.h"
#include "extensions/days/activity.h"
#include "record/edit.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"
#include "sim/simulation.h"

namespace ispace::curtains {
namespace curtains_with_days_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Curtain, LetsPeoplePass) {
    testing::addCurtainsOnce();
    const Scene scene =
        makeScene(readRecordText("#env 1\nispace size=8,4\nzone id=right at=2,0 size=4,4\n"
                                 "curtain id=c from=0,-2 to=0,2\nhuman id=ann at=-2,0\n",
                                 "room.env", sceneSchemas()),
                  nullptr, shippedDevices());
    World world(scene, milliseconds(100));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    simulation.follow(
        days::readDays("at 00:00 ann closes c; goes right; opens c\n", "s.txt", world));
    std::vector<std::string> changes;
    for (int i = 0; i < 80; ++i) {
        while (simulation.isChangeDue()) {
            changes.push_back(simulation.takeScriptedChange());
            world.change(makeScene(editedRecords(world.scene(), parseEdits(changes.back()),
                                                 [](const std::string&) { return std::nullopt; }),
                                   world.scene(), shippedDevices()));
        }
        simulation.allow(1);
        simulation.run(std::chrono::steady_clock::now(), seconds(10));
    }
    EXPECT_GT(world.status(0).pose.position.x, 0.5);
    EXPECT_EQ(changes, (std::vector<std::string>{"SET c.drawn=1", "SET c.drawn=0"}));
    EXPECT_EQ(roomStates(world.scene()), (std::vector<RoomState>{{"c", "drawn", "0"}}));
}

}  // namespace curtains_with_days_test
}  // namespace ispace::curtains
