// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "extensions/bumpers/bumper.h"
#include "extensions/bumpers/bumpers_test.h"
#include "extensions/passages/passages_test.h"

namespace ispace::bumpers {
namespace bumpers_with_passages_test {

/// In a building, the bumper is of a robot of its storey, and goes along with it.
TEST(BumperService, GoesToOtherStoreys) {
    for (const char* const of : {"ground/r", "r"}) {
        testing::addBumpersOnce();
        SiteScene building = testing::buildingOf(
            std::string("robot id=ground/r at=6,4 accel=100 max_speed=3 mass=25\n"
                        "bumper id=ground/b stiffness=10000 of=") +
            of + '\n');
        passages::BuildingRun run(building, testing::optionsOf(std::chrono::milliseconds(20)));
        std::vector<RunRoom> rooms;
        for (const auto& room : run.rooms()) rooms.push_back({room.id, &*room.simulation});
        const auto service = makeBumpers(rooms, 1);
        ASSERT_NE(service, nullptr);
        ASSERT_EQ(run.travel("ground/r", {{{1, {9, 6}}}}).refusal, "");
        ASSERT_TRUE(testing::await(run, "ground/r", 60));
        ASSERT_EQ(run.roomOf("ground/r"), 1U);
        World& upper = run.rooms()[1].simulation->world();
        const auto mover = upper.robotNamed("ground/r").value();
        upper.command(mover, {.verb = Verb::Speed, .value = 1.2});
        double force = 0;
        for (int i = 0; i < 1000; ++i) {
            testing::step(run);
            service->stepped();
            for (const RoomState& state : service->states()) {
                EXPECT_EQ(state.id, "ground/b");
                force = std::max(force, std::stod(state.value));
            }
        }
        EXPECT_GT(force, 100) << of;
        EXPECT_LE(force, 600.1) << of;
    }
}

}  // namespace bumpers_with_passages_test
}  // namespace ispace::bumpers
