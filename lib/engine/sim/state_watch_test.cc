// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/state_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "sim/command.h"
#include "sim/simulation.h"
#include "support/test_layout.h"

namespace ispace {
namespace state_watch_test {

using std::chrono::milliseconds;
using States = std::vector<RoomState>;

constexpr const char* kLayout =
    "mat id=s1 at=0,0 size=0.6,0.6\n"
    "human id=h1 at=-1,0\n";

Scene roomWith(const std::string& door, const std::string& lamp) {
    return testing::scene(
        "ispace size=10,6\ndoor id=d1 at=0,3 " + door + "\nlamp id=l1 " + lamp + "\n", kLayout);
}

TEST(StateWatch, TellsReadingsAndRecordsThatChange) {
    const Scene room = roomWith("", "");
    World world(room, milliseconds(100));
    EXPECT_EQ(statesOf(world), (States{{"d1", "open", "0"},
                                       {"l1", "on", "0"},
                                       {"l1", "level", "1"},
                                       {"l1", "color", "1,1,0.97"},
                                       {"s1", "n", "0"},
                                       {"s1", "on", "-"}}));
    StateWatch watch(world);
    world.step();
    EXPECT_TRUE(watch.changed().empty());
    world.command(0, {Verb::Forward, 2});
    States told;
    for (int i = 0; i < 30; ++i) {
        world.step();
        for (RoomState& state : watch.changed()) told.push_back(std::move(state));
    }
    EXPECT_EQ(told,
              (States{{"s1", "n", "1"}, {"s1", "on", "h1"}, {"s1", "n", "0"}, {"s1", "on", "-"}}));
    world.change(roomWith("open=yes", "on=yes level=20%"));
    world.step();
    EXPECT_EQ(watch.changed(),
              (States{{"d1", "open", "1"}, {"l1", "on", "1"}, {"l1", "level", "0.2"}}));
}

TEST(StateEvents, FollowASubscription) {
    const Scene room = roomWith("", "");
    World world(room, milliseconds(100));
    Simulation simulation(world, {}, {Clock::Kind::Step}, {});
    simulation.events().want({EventKind::State});
    const auto step = [&] {
        simulation.allow(1);
        simulation.run(std::chrono::steady_clock::now(), std::chrono::seconds(1));
    };
    step();
    EXPECT_EQ(simulation.events().next(), 0) << "known states are no events";
    world.change(roomWith("", "on=yes"));
    step();
    ASSERT_EQ(simulation.events().next(), 1);
    std::string row;
    appendEventRow(row, simulation.events().at(0));
    EXPECT_EQ(row, "0.2,state,l1,on,,,,1\n");
}

TEST(Script, ActsAreChecked) {
    const Scene room = roomWith("", "");
    const World world(room, milliseconds(100));
    const auto commands =
        readScript("2 l1 act level=30%\n1 d1 ACT open=1\n0 h1 FORWARD 1\n", "s.txt", world);
    ASSERT_EQ(commands.size(), 3U);
    EXPECT_EQ(commands[0].change, "");
    EXPECT_EQ(commands[1].change, "SET d1.open=yes");
    EXPECT_EQ(commands[2].change, "SET l1.level=30%");
    const auto finding = [&](const std::string& line) {
        try {
            readScript(line, "s.txt", world);
        } catch (const FormatError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(finding("1 l1 ACT"),
              "s.txt:1:6: error: ACT wants a state, like 2.5 lamp1 ACT on=yes");
    EXPECT_EQ(finding("1 h1 ACT on=1"), "s.txt:1:3: error: h1 is a human, which has no state");
    EXPECT_NE(finding("1 l1 ACT level=2").find("s.txt:1:10: error: "), std::string::npos);
    EXPECT_NE(finding("1 l1 ACT on=maybe").find("neither yes nor no"), std::string::npos);
}

}  // namespace state_watch_test
}  // namespace ispace
