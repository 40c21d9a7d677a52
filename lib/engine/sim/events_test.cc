// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/events.h"

#include <gtest/gtest.h>

#include "sim/simulation.h"
#include "support/test_layout.h"

namespace ispace {
namespace events_test {

using std::chrono::milliseconds;
using testing::scene;

const std::string kRoom = "ispace id=room size=8,6\nzone id=z1 at=2,0 size=2,2\n";
const std::string kRobot = "robot id=r1 model=pioneer-2dx at=0,0\n";

/// A world that is watched.
struct Watched {
    explicit Watched(const std::string& layout, const EventKinds& kinds = allEventKinds())
        : room(scene(kRoom, layout)),
          world(room, milliseconds(100)),
          simulation(world, {}, {Clock::Kind::Fast, 1}, std::nullopt) {
        simulation.events().want(kinds);
    }
    /// The rows of what happens until then, a line each.
    std::string until(SimTime time) {
        const EventLog& log = simulation.events();
        std::string rows;
        simulation.pause({});
        while (world.time() < time) {
            simulation.allow(1);
            simulation.run({}, std::chrono::hours(1));
            for (; next < log.next(); ++next) appendEventRow(rows, log.at(next));
        }
        return rows;
    }
    Scene room;
    World world;
    Simulation simulation;
    std::int64_t next = 0;
};

TEST(Events, NamesAreThereAndBack) {
    EXPECT_EQ(allEventKinds().size(), kEventKinds);
    for (const EventKind kind : allEventKinds()) EXPECT_EQ(eventKindNamed(nameOf(kind)), kind);
    EXPECT_EQ(eventKindNamed("tea"), std::nullopt);
}

TEST(Events, ARowQuotesItsText) {
    std::string row;
    appendEventRow(row,
                   {.kind = EventKind::Mark, .time = milliseconds(1500), .text = "say \"a,b\""});
    EXPECT_EQ(row, "1.5,mark,,,,,,\"say \"\"a,b\"\"\"\n");
    row.clear();
    appendEventRow(row, {.kind = EventKind::Activity,
                         .time = milliseconds(2000),
                         .id = "h1",
                         .other = "cook,\"eat",
                         .text = "goes far"});
    EXPECT_EQ(row, "2,activity,h1,\"cook,\"\"eat\",,,0,goes far\n");
    const std::string_view head = eventTableHead();
    EXPECT_EQ(std::count(head.begin(), head.end(), ','), 7);
}

TEST(Events, CollisionAndZones) {
    Watched run(kRobot);
    run.world.command(0, {Verb::Forward, 9});
    const std::string rows = run.until(std::chrono::seconds(30));
    EXPECT_EQ(rows.substr(0, rows.find(",enter")), "2.9");
    EXPECT_NE(rows.find(",enter,r1,z1,1.0"), std::string::npos) << rows;
    EXPECT_NE(rows.find(",leave,r1,z1,3.0"), std::string::npos) << rows;
    EXPECT_NE(rows.find(",collision,r1,room,3.7"), std::string::npos) << rows;
    EXPECT_NE(rows.find(",stall,r1,,,,,\n"), std::string::npos) << rows;
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 4);
}

TEST(Events, WhoIsInAZoneEntersIt) {
    Watched run("robot id=r1 at=2,0\nrobot id=r2 at=-2,0\n");
    EXPECT_EQ(run.until(milliseconds(100)), "0.1,enter,r1,z1,2,0,,\n");
    EXPECT_EQ(run.until(std::chrono::seconds(2)), "");
}

TEST(Events, PeopleCountAsRobotsDo) {
    Watched run("human id=h1 at=2,0\nlaser id=l1 at=0,0 fov=20 step=1 range=4\n");
    EXPECT_EQ(run.until(milliseconds(100)), "0.1,enter,h1,z1,2,0,,\n0.1,seen,h1,,,,1,\n");
}

TEST(Events, SeenAndLost) {
    // The laser looks along the x axis, 2 m far.
    Watched run("robot id=r1 at=-1,0 heading=90\nlaser id=l1 at=-2,0 fov=20 step=1 range=2\n");
    EXPECT_EQ(run.until(milliseconds(100)), "0.1,seen,r1,,,,1,\n");
    run.world.command(0, {Verb::Forward, 2});
    const std::string rows = run.until(std::chrono::seconds(5));
    EXPECT_NE(rows.find(",lost,r1,,,,,\n"), std::string::npos) << rows;
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1) << rows;
}

TEST(Events, AMoverAtRestIsSeenByASensorThatComes) {
    const std::string robot = "robot id=r1 at=-1,0\n", laser = "laser at=-2,0 range=2\n";
    Watched run(robot);
    EXPECT_EQ(run.until(milliseconds(500)), "");
    run.world.change(scene(kRoom, robot + laser));
    EXPECT_EQ(run.until(milliseconds(1000)), "0.6,seen,r1,,,,1,\n");
    EXPECT_EQ(run.until(milliseconds(1500)), "");
    run.world.change(scene(kRoom, robot));
    EXPECT_EQ(run.until(milliseconds(2000)), "1.6,lost,r1,,,,,\n");
}

TEST(Events, MatsAndGates) {
    Watched run(
        "robot id=r1 model=pioneer-2dx at=-3,2\nmat id=m1 at=-1,2 size=1,1\n"
        "gate id=g1 at=1,2 width=1 height=0.1\n");
    run.world.command(0, {Verb::Forward, 6});
    const std::string rows = run.until(std::chrono::seconds(20));
    EXPECT_NE(rows.find(",mat,m1,r1,,,1,\n"), std::string::npos) << rows;
    EXPECT_NE(rows.find(",mat,m1,r1,,,0,\n"), std::string::npos) << rows;
    EXPECT_NE(rows.find(",gate,g1,r1,,,1,\n"), std::string::npos) << rows;
    // Their states change besides: n and on of the mat twice, in, out and broken of the gate.
    EXPECT_NE(rows.find(",state,m1,on,,,,r1\n"), std::string::npos) << rows;
    EXPECT_NE(rows.find(",state,g1,in,,,,1\n"), std::string::npos) << rows;
    std::size_t others = 0;
    for (std::size_t at = rows.find('\n'); at != std::string::npos; at = rows.find('\n', at + 1))
        ++others;
    for (std::size_t at = rows.find(",state,"); at != std::string::npos;
         at = rows.find(",state,", at + 1))
        --others;
    EXPECT_EQ(others, 3U) << rows;
}

TEST(Events, OnlyWhatIsWanted) {
    Watched run(kRobot, {EventKind::Leave});
    run.world.command(0, {Verb::Forward, 9});
    std::string rows = run.until(std::chrono::seconds(30));
    EXPECT_NE(rows.find(",leave,"), std::string::npos);
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1) << rows;
    run.simulation.events().unwant({EventKind::Leave});
    run.world.command(0, {Verb::Backward, 9});
    EXPECT_EQ(run.until(std::chrono::seconds(60)), "");
}

TEST(Events, AChangeOfTheWorldKeepsWhoIsWhere) {
    Watched run("robot id=r1 at=2,0\n");
    run.until(milliseconds(100));
    run.simulation.events().add(EventKind::Change, "ADD robot id=r0");
    run.world.change(scene(kRoom, "robot id=r0 at=2.7,0\nrobot id=r1 at=2,0\n"));
    EXPECT_EQ(run.until(milliseconds(200)),
              "0.1,change,,,,,,ADD robot id=r0\n0.2,enter,r0,z1,2.7,0,,\n");
}

TEST(Events, WhoGivesUpIsTold) {
    // A path of a record goes on to its next point; a commanded one ends.
    Watched run(
        "human id=h1 at=0,0 path=3,0;0,-2;3,0 speed=1\nrobot id=r1 at=0,2\n"
        "cube id=box at=3,0 size=1.4,1.4,1\n",
        {EventKind::Unreached});
    run.world.command(0, pathCommand({.path = {{9, 2}, {0, 2}}}));
    const std::string rows = run.until(std::chrono::seconds(60));
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 3) << rows;
    EXPECT_NE(rows.find(",unreached,r1,,9,2,,\n"), std::string::npos) << rows;
    const auto first = rows.find(",unreached,h1,,3,0,,\n");
    ASSERT_NE(first, std::string::npos) << rows;
    EXPECT_NE(rows.find(",unreached,h1,,3,0,,\n", first + 1), std::string::npos) << rows;
    // One attempt of several is none.
    Command attempt = pathCommand({.path = {{9, 2}}});
    attempt.is_attempt = true;
    run.world.command(0, attempt);
    EXPECT_EQ(run.until(std::chrono::seconds(120)), "");
    EXPECT_EQ(run.world.running(0), 0);
}

TEST(Events, OldOnesGo) {
    Watched run("");
    EventLog& log = run.simulation.events();
    for (int i = 0; i < 50000; ++i) log.add(EventKind::Mark, std::to_string(i));
    EXPECT_EQ(log.next(), 50000);
    EXPECT_GT(log.first(), 30000);
    EXPECT_EQ(log.at(log.first()).text, std::to_string(log.first()));
    EXPECT_EQ(log.at(49999).text, "49999");
}

}  // namespace events_test
}  // namespace ispace
