// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "env/environment.h"
#include "extensions/curtains/curtain.h"
#include "extensions/curtains/curtains_test.h"
#include "record/edit.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"
#include "sim/activity.h"
#include "sim/goal_paths.h"
#include "sim/simulation.h"

namespace ispace::curtains {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Scene sceneOf(const std::string& curtain) {
    testing::addCurtainsOnce();
    const std::string room =
        "#env 1\nispace size=8,4\nzone id=left at=-2,0 size=4,4\nzone id=right at=2,0 size=4,4\n" +
        curtain + "human id=ann at=-2,0\n";
    return makeScene(readRecordText(room, "room.env", sceneSchemas()), nullptr, shippedDevices());
}

const std::string kAcross = "curtain id=c from=0,-2 to=0,2 ";

std::string refusal(const std::string& curtain) {
    try {
        sceneOf(curtain);
    } catch (const FormatError& error) {
        return error.diagnostics().front().text();
    }
    return "";
}

TEST(Curtain, HasAnExtent) {
    EXPECT_EQ(refusal(kAcross + "drawn=0.5\n"), "");
    EXPECT_NE(refusal("curtain from=1,1 to=1,1\n").find("has no length"), std::string::npos);
    EXPECT_NE(refusal(kAcross + "bottom=2 height=2\n").find("wanted bottom < height"),
              std::string::npos);
    EXPECT_NE(refusal(kAcross + "drawn=1.1\n"), "");
}

/// Light stops at the drawn share of the rail; movers pass all of it.
TEST(Curtain, StopsLightAsFarAsItIsDrawn) {
    for (const double drawn : {0.0, 0.25, 0.6, 1.0}) {
        const Scene scene = sceneOf(kAcross + "drawn=" + std::to_string(drawn) + '\n');
        for (const double height : {0.0, 1.0, 2.3, 2.4}) {
            double cloth = 0;
            const Slice slice = scene.environment.slice(height);
            for (const Segment2& line : slice.sheets)
                if (line.a.x == 0 && line.b.x == 0) cloth += distance(line.a, line.b);
            EXPECT_NEAR(cloth, height > 2.3 ? 0 : 4 * drawn, 1e-12) << height;
        }
        for (const Segment2& line : scene.environment.band(0, 1.7).sheets)
            EXPECT_FALSE(line.a.x == 0 && line.b.x == 0);
    }
}

TEST(Curtain, LetsPeoplePass) {
    const Scene scene = sceneOf(kAcross + '\n');
    EXPECT_FALSE(GoalPaths(scene, 0.25, 1.7).way({-2, 0}, "right").empty());
    World world(scene, milliseconds(100));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    simulation.follow(readDayPlan("at 00:00 ann closes c; goes right; opens c\n", "s.txt", world));
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

}  // namespace
}  // namespace ispace::curtains
