// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/activity.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "sim/goal_ways.h"
#include "sim/simulation.h"
#include "support/test_layout.h"

namespace ispace {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

/// Two rooms behind each other; the door between them is in the middle.
Scene home(const std::string& door = "open=yes", const std::string& ann = "at=-4,2") {
    return testing::scene(
        "fence id=f path=-5,-3;5,-3;5,3;-5,3 closed=yes\n"
        "fence id=w path=0,-3;0,3\n"
        "door id=d wall=w at=0,0 " +
            door +
            "\ninside at=-2,0\ninside at=2,0\n"
            "zone id=left at=-2.5,0 size=5,6\nzone id=right at=2.5,0 size=5,6\n"
            "cube id=box at=4.5,2.5 size=0.6,0.6,0.6\nlamp id=l at=1,1\n",
        "human id=a " + ann + "\nhuman id=b at=3,-2\n");
}

TEST(DayPlan, ReadsTimesNamesAndActions) {
    const Scene room = home();
    const World world(room, seconds(1));
    const DayPlan plan = readDayPlan(
        "# a day\n"
        "daily 07:30 a breakfast: goes right; uses box 3min;stays 1h ;\n"
        "0 a FORWARD 1\n"
        "at 2 06:00:30 b opens d\n"
        "at 00:00 b tea: switches l on; closes d\n",
        "s.txt", world);
    ASSERT_EQ(plan.lines.size(), 3U);
    EXPECT_EQ(plan.lines[0].name, "tea");
    EXPECT_EQ(plan.lines[0].actions[0].change, "SET l.on=yes");
    EXPECT_EQ(plan.lines[0].actions[1].change, "SET d.open=no");
    EXPECT_EQ(plan.lines[1].time, hours(7) + minutes(30));
    EXPECT_TRUE(plan.lines[1].is_daily);
    ASSERT_EQ(plan.lines[1].actions.size(), 3U);
    EXPECT_EQ(plan.lines[1].actions[1].text, "uses box 3min");
    EXPECT_EQ(plan.lines[1].actions[1].target, "box");
    EXPECT_EQ(plan.lines[1].actions[1].lasts, minutes(3));
    EXPECT_EQ(plan.lines[2].time, hours(30) + seconds(30));
    EXPECT_EQ(plan.lines[2].name, "opens_d");
    EXPECT_EQ(readScript("at 00:00 a goes left\n0 a FORWARD 1\n", "s.txt", world).size(), 1U);
}

TEST(DayPlan, NamesAreWords) {
    const Scene room = home();
    const World world(room, seconds(1));
    try {
        readDayPlan("at 00:00 a tea: goes right\nat 00:00:02 a cook,\"eat: goes right\n", "s.txt",
                    world);
        FAIL() << "a name with a comma";
    } catch (const FormatError& error) {
        EXPECT_EQ(std::string(error.what()),
                  "s.txt:2:15: error: `cook,\"eat` is no name of an activity: letters, digits and "
                  "_-./+:@ are wanted");
    }
}

TEST(GoalWays, GoesThroughOpenDoorsAlone) {
    const Point2 from{-4, 2};
    const GoalWays open(home(), 0.25, 1.7), shut(home(""), 0.25, 1.7);
    EXPECT_TRUE(shut.way(from, "right").empty());
    EXPECT_TRUE(open.way(from, "nowhere").empty());
    const std::vector<Point2> way = open.way(from, "right");
    ASSERT_GE(way.size(), 2U);
    EXPECT_NEAR(way.back().x, 2.5, 0.1);
    EXPECT_NEAR(way.back().y, 0, 0.1);
    // No corner cuts a wall.
    const Scene room = home();
    const Obstacles obstacles(room.environment, 1.7, nullptr);
    Point2 last = from;
    for (const Point2 next : way) {
        EXPECT_FALSE(obstacles.near({last, next}, 0.25));
        last = next;
    }
    // In front of a thing, as near as a person may come.
    const Point2 there = open.way(from, "box").back();
    EXPECT_LT(distance(there, Point2{4.5, 2.5}), 0.95);
    EXPECT_FALSE(obstacles.overlap(there, 0.25));
}

struct Lived {
    explicit Lived(const std::string& script, const Scene& scene = home(),
                   SimTime step = milliseconds(500))
        : room(scene), world(room, step), simulation(world, {}, {Clock::Kind::Step, 1}, {}) {
        simulation.events().want({EventKind::Activity});
        simulation.follow(readDayPlan(script, "s.txt", world));
    }
    void run(int steps) {
        simulation.allow(steps);
        while (simulation.owed() > 0)
            simulation.run(std::chrono::steady_clock::now(), std::chrono::seconds(10));
    }
    [[nodiscard]] std::vector<std::string> events() const {
        std::vector<std::string> rows;
        const EventLog& log = simulation.events();
        constexpr std::string_view kSigns = "!-+";
        for (std::int64_t i = log.first(); i < log.next(); ++i)
            rows.push_back(
                std::string(kSigns.substr(static_cast<std::size_t>(log.at(i).value + 1), 1)) +
                log.at(i).id + ' ' + log.at(i).other + ": " + log.at(i).text);
        return rows;
    }

    Scene room;
    World world;
    Simulation simulation;
};

TEST(ActivityDirector, DoesOneActionAfterAnother) {
    Lived day("at 00:00 a tea: goes right; stays 5s; uses box 2s\nat 00:00:10 a rest: stays 1s\n");
    day.run(120);
    EXPECT_EQ(day.events(), (std::vector<std::string>{"+a tea: goes right", "-a tea: goes right",
                                                      "+a tea: stays 5s", "-a tea: stays 5s",
                                                      "+a tea: uses box 2s", "-a tea: uses box 2s",
                                                      "+a rest: stays 1s", "-a rest: stays 1s"}));
    const EventLog& log = day.simulation.events();
    EXPECT_EQ(log.at(3).time - log.at(2).time, seconds(5));
    EXPECT_GE(log.at(5).time - log.at(4).time, seconds(2));
    EXPECT_LT(distance(day.world.status(0).pose.position, Point2{4.5, 2.5}), 0.95);
}

TEST(ActivityDirector, GivesUpWithoutAWay) {
    Lived day("at 00:00 a goes right; stays 1s\n", home(""));
    day.run(40);
    EXPECT_EQ(day.events(),
              (std::vector<std::string>{"+a goes_right: goes right", "!a goes_right: goes right",
                                        "+a goes_right: stays 1s", "-a goes_right: stays 1s"}));
    const EventLog& log = day.simulation.events();
    EXPECT_GE(log.at(1).time - log.at(0).time, seconds(4)) << "tries again";
    EXPECT_EQ(day.world.status(0).pose.position, (Point2{-4, 2}));
}

TEST(ActivityDirector, GoesOnWhenAnotherTakesOver) {
    const std::vector<std::pair<std::string, std::function<void(World&)>>> cases = {
        {"RESET", [](World& world) { world.restart(Scene(*world.sharedStart())); }},
        {"LOAD", [](World& world) { world.restart(home("open=yes", "at=-3,1")); }},
        {"SET a.at", [](World& world) { world.change(home("open=yes", "at=-3,1")); }},
        {"SET a.path",
         [](World& world) { world.change(home("open=yes", "at=-4,2 path=-4,-2;-4,2 loop=yes")); }},
        {"STOP",
         [](World& world) {
             world.command(0, {Verb::Stop, 0});
         }},
        {"FORWARD",
         [](World& world) {
             world.command(0, {Verb::Forward, 0.1});
         }},
        {"SPEED", [](World& world) {
             world.command(0, {Verb::Speed, 0.1});
         }}};
    for (const auto& [name, meddle] : cases) {
        Lived day("at 00:00 a goes right; stays 1s\n");
        day.run(6);
        ASSERT_NE(day.world.status(0).pose.position, (Point2{-4, 2})) << "under way";
        meddle(day.world);
        day.run(120);
        EXPECT_EQ(day.events().size(), 4U) << name;
        EXPECT_LT(distance(day.world.status(0).pose.position, Point2{2.5, 0}), 0.1) << name;
    }
}

TEST(ActivityDirector, TallPeopleTakeHighDoors) {
    // The low door is nearer to both, in either order of departure.
    const Scene room = testing::scene(
        "fence id=shell path=-5,-2;5,-2;5,2;-5,2 closed=yes height=2.5\n"
        "wall id=w1 from=0,-2 to=0,2 height=2.5\n"
        "door id=low wall=w1 at=0,-1 size=0.9 height=1.2 open=yes\n"
        "door id=high wall=w1 at=0,1.3 size=0.9 height=2.1 open=yes\n"
        "inside at=-4,0\nzone id=far at=3.5,-1 size=2,1\nzone id=near at=1,-1.4 size=1,0.8\n",
        "human id=child at=-4,0 height=1.1\nhuman id=tall at=-4,-1 height=1.8\n");
    for (const bool is_child_first : {true, false}) {
        const std::string second = is_child_first ? "tall goes far" : "child goes near";
        Lived day("at 00:00 " + std::string(is_child_first ? "child goes near" : "tall goes far") +
                      "\nat 00:00:20 " + second + '\n',
                  room);
        day.run(80);
        const EventLog& log = day.simulation.events();
        ASSERT_EQ(log.next(), 4) << second;
        EXPECT_EQ(log.at(1).value, 0);
        EXPECT_EQ(log.at(3).value, 0) << second;
        EXPECT_LE(log.at(3).time - log.at(2).time, seconds(15)) << second;
    }
}

TEST(ActivityDirector, PeopleStandBesideEachOther) {
    // One after another, both at once, beside a robot that stands there, and long steps.
    for (const auto step : {milliseconds(50), milliseconds(1000)})
        for (const std::string when : {"00:00", "00:00:15"}) {
            Lived day(
                "at 00:00 a goes right; stays 1h\nat " + when + " c goes right; stays 1h\n",
                testing::scene("ispace size=12,6\nzone id=right at=3,0 size=3,3\n",
                               "robot id=r at=3,0\nhuman id=a at=-4,1\nhuman id=c at=-4,-1\n"),
                step);
            day.run(static_cast<int>(seconds(40) / step));
            const EventLog& log = day.simulation.events();
            ASSERT_EQ(log.next(), 6);
            const SimTime begun = when == "00:00" ? SimTime(0) : seconds(15);
            for (std::int64_t i = 0; i < log.next(); ++i) {
                const SimTime since = log.at(i).id == "a" ? SimTime(0) : begun;
                if (log.at(i).value == 1) continue;
                EXPECT_EQ(log.at(i).value, 0) << when << ' ' << log.at(i).id;
                EXPECT_LT(log.at(i).time - since, seconds(16)) << when << ' ' << log.at(i).id;
            }
            for (const std::size_t person : {1U, 2U})
                EXPECT_LT(distance(day.world.status(person).pose.position, Point2{3, 0}), 1.3);
        }
}

TEST(ActivityDirector, InAFullZoneIsThere) {
    // The robot beside it leaves no free point: one person is in it, the other comes too late.
    Lived day("at 00:00 a goes spot\nat 00:00 c goes spot\n",
              testing::scene("ispace size=8,6\nzone id=spot at=2,0 size=0.4,0.4\n",
                             "robot id=r at=2.42,0\nhuman id=a at=1.85,0\nhuman id=c at=-3,0\n"));
    day.run(200);
    EXPECT_EQ(day.events(),
              (std::vector<std::string>{"+a goes_spot: goes spot", "+c goes_spot: goes spot",
                                        "-a goes_spot: goes spot", "!c goes_spot: goes spot"}));
}

TEST(ActivityDirector, AsksForChanges) {
    Lived day("at 00:00 a switches l on; closes d\n");
    day.run(1);
    EXPECT_EQ(day.simulation.takeScriptedChange(), "SET l.on=yes");
    EXPECT_EQ(day.simulation.takeScriptedChange(), "");
    day.run(1);
    EXPECT_EQ(day.simulation.takeScriptedChange(), "SET d.open=no");
}

TEST(ActivityDirector, RepeatsDays) {
    Lived day("daily 00:00:01 a stays 1s\n");
    day.run(2 * (24 * 3600 + 10));
    EXPECT_EQ(day.events().size(), 4U);
    EXPECT_EQ(day.simulation.events().at(2).time - day.simulation.events().at(0).time, hours(24));
}

}  // namespace
}  // namespace ispace
