// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/days/activity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "extensions/days/goal_paths.h"
#include "sim/simulation.h"
#include "support/test_layout.h"

namespace ispace::days {
namespace activity_test {

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
    EXPECT_EQ(plan.lines[0].actions[0].target, "l");
    EXPECT_EQ(plan.lines[0].actions[0].changes, "on=yes");
    EXPECT_EQ(plan.lines[0].actions[1].act, "closes");
    EXPECT_EQ(plan.lines[0].actions[1].changes, "open=no");
    EXPECT_EQ(plan.lines[1].time, hours(7) + minutes(30));
    EXPECT_TRUE(plan.lines[1].is_daily);
    ASSERT_EQ(plan.lines[1].actions.size(), 3U);
    EXPECT_EQ(plan.lines[1].actions[1].text, "uses box 3min");
    EXPECT_EQ(plan.lines[1].actions[1].target, "box");
    EXPECT_EQ(plan.lines[1].actions[1].lasts, minutes(3));
    EXPECT_EQ(plan.lines[2].time, hours(30) + seconds(30));
    EXPECT_EQ(plan.lines[2].name, "opens_d");
}

TEST(DayPlan, IsAPartOfAScript) {
    addDays();
    const Scene room = home();
    const World world(room, seconds(1));
    const std::string both = "at 00:00 a goes left\n0 a FORWARD 1\n";
    EXPECT_EQ(readScript(both, "s.txt", world).size(), 1U);
    EXPECT_EQ(readDirectors(both, "s.txt", world).size(), 1U);
    EXPECT_TRUE(readDirectors("0 a FORWARD 1\n", "s.txt", world).empty());
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

TEST(GoalPaths, GoesThroughOpenDoorsAlone) {
    const Point2 from{-4, 2};
    const GoalPaths open(home(), 0.25, 1.7), shut(home(""), 0.25, 1.7);
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

/// A sofa in a corner, and a bunk behind a shut door, in the room beside which one may stand
/// nearer to it than on its own side.
Scene flat(const std::string& door) {
    return testing::scene(
        "ispace size=9,6,2.5\ninside at=-3,0\ninside at=2,2\ninside at=2,-2\n"
        "wall id=wa from=0,-3 to=0,3\nwall id=wb from=0,0 to=4.5,0\n"
        "door id=dk wall=wa at=0,1.5 open=yes\ndoor id=db wall=wa at=0,-1.5 " +
            door +
            "\ncube id=sofa at=-3.9,1 size=0.9,2,0.6\ncube id=bunk at=3.4,-2.2 size=2,1,0.5\n"
            "cube id=chest at=1,-0.31 size=0.8,0.6,0.5\nheater id=he at=-4.3,2.8\n",
        "human id=a at=2,1.5\n");
}

TEST(GoalPaths, EndsBesideThings) {
    const GoalPaths open(flat("open=yes"), 0.25, 1.7), shut(flat(""), 0.25, 1.7);
    const Point2 from{2, 1.5};
    const std::vector<Point2> way = open.way(from, "sofa");
    ASSERT_FALSE(way.empty());
    EXPECT_LE(way.back().x, -3.45 + GoalPaths::kReach);
    EXPECT_TRUE(open.isAt(way.back(), "sofa"));
    EXPECT_FALSE(open.isAt({0.15, 1.45}, "sofa"));
    // The wall wb parts the chest from the kitchen.
    EXPECT_FALSE(open.isAt({1, 0.3}, "chest"));
    EXPECT_TRUE(open.isAt({1, -0.9}, "chest"));
    const std::vector<Point2> round = open.way(from, "chest");
    ASSERT_FALSE(round.empty());
    EXPECT_LT(round.back().y, 0);
    EXPECT_TRUE(shut.way(from, "bunk").empty());
    EXPECT_TRUE(shut.way(from, "chest").empty());
    EXPECT_FALSE(shut.way(from, "he").empty());
}

struct Lived {
    explicit Lived(const std::string& script, const Scene& scene = home(),
                   SimTime step = milliseconds(500))
        : room(scene), world(room, step), simulation(world, {}, {Clock::Kind::Step, 1}, {}) {
        simulation.events().want({EventKind::Activity});
        if (auto days = readDays(script, "s.txt", world)) simulation.follow(std::move(days));
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

TEST(ActivityDirector, WhoGivesUpSaysSo) {
    Lived day("at 00:00 a goes right; uses box 2s\n", home(""));
    day.simulation.events().want({EventKind::Unreached});
    day.simulation.events().unwant({EventKind::Activity});
    day.run(200);
    const EventLog& log = day.simulation.events();
    // Once for each target, however often it tries.
    ASSERT_EQ(log.next(), 2);
    EXPECT_EQ(log.at(0).id, "a");
    EXPECT_EQ(log.at(0).other, "right");
    EXPECT_EQ(log.at(1).other, "box");
    EXPECT_FALSE(log.at(1).place);
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

/// A flat of 8 by 6 m with a wall across, a door in it that is open or shut, and boxes.
struct RandomFlat {
    struct Box {
        Point2 center;
        Vec2 half;
    };
    explicit RandomFlat(unsigned seed) : random(seed) {
        wall = number(-1.5, 1.5);
        door = number(-2.2, 2.2);
        is_open = number(0, 1) < 0.7;
        for (int i = 0; i < 60 && boxes.size() < 6; ++i) add();
    }
    double number(double low, double high) {
        return low + (high - low) * static_cast<double>(random() % 10'000) / 10'000;
    }
    /// Adds a box at a wall, or anywhere, if it keeps out of the wall across and the start.
    void add() {
        const Vec2 half{number(0.15, 0.8), number(0.15, 0.8)};
        Point2 at{number(-4 + half.x, 4 - half.x), number(-3 + half.y, 3 - half.y)};
        if (number(0, 1) < 0.5) at.y = at.y > 0 ? 3 - half.y : half.y - 3;
        const bool is_across = std::abs(at.x - wall) < half.x + 0.01;
        const bool is_at_start =
            std::abs(at.x + 3.5) < half.x + 0.4 && std::abs(at.y) < half.y + 0.4;
        const bool is_taken = std::any_of(boxes.begin(), boxes.end(), [&](const Box& other) {
            return std::abs(at.x - other.center.x) < half.x + other.half.x &&
                   std::abs(at.y - other.center.y) < half.y + other.half.y;
        });
        if (!is_across && !is_at_start && !is_taken) boxes.push_back({at, half});
    }
    [[nodiscard]] Scene scene() const {
        std::string text =
            "ispace size=8,6,2.5\ninside at=-3.9,0\ninside at=3.9,0\nwall id=w from=" +
            formatDouble(wall) + ",-3 to=" + formatDouble(wall) +
            ",3\ndoor id=d wall=w at=" + formatDouble(wall) + ',' + formatDouble(door) +
            (is_open ? " open=yes\n" : "\n");
        for (std::size_t i = 0; i < boxes.size(); ++i)
            text += "cube id=b" + std::to_string(i) + " at=" + formatDouble(boxes[i].center.x) +
                    ',' + formatDouble(boxes[i].center.y) +
                    " size=" + formatDouble(2 * boxes[i].half.x) + ',' +
                    formatDouble(2 * boxes[i].half.y) + ",0.6\n";
        return testing::scene(text, "human id=a at=-3.5,0\n");
    }
    [[nodiscard]] std::string days() const {
        std::string text;
        for (std::size_t i = 0; i < boxes.size(); ++i)
            text += "at 00:00 a use: uses b" + std::to_string(i) + " 5s\n";
        return text;
    }
    /// Returns true at most 0.6 m from the box, on its side of the wall: no box is across it.
    [[nodiscard]] bool isBeside(Point2 p, const Box& box) const {
        const double dx = std::max(0.0, std::abs(p.x - box.center.x) - box.half.x);
        const double dy = std::max(0.0, std::abs(p.y - box.center.y) - box.half.y);
        if (std::hypot(dx, dy) > 0.6) return false;
        if ((p.x < wall) == (box.center.x < wall)) return true;
        // Through the open door.
        return is_open && std::abs(p.y - door) < 0.5;
    }

    std::mt19937 random;
    double wall = 0, door = 0;
    bool is_open = false;
    std::vector<Box> boxes;
};

TEST(ActivityDirector, LabelsOfRandomFlatsAreTrue) {
    int done = 0, given_up = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        const RandomFlat flat(seed);
        Lived day(flat.days(), flat.scene(), milliseconds(250));
        std::int64_t next = 0;
        std::vector<Point2> ways;
        for (int step = 0; step < 4 * 240; ++step) {
            day.run(1);
            const EventLog& log = day.simulation.events();
            const Point2 place = day.world.status(0).pose.position;
            ways.push_back(place);
            for (; next < log.next(); ++next) {
                const Event& event = log.at(next);
                if (event.value == 1) continue;
                const auto box = static_cast<std::size_t>(event.text[6] - '0');
                if (event.value == -1) {
                    ++given_up;
                    continue;
                }
                ++done;
                // All through the five seconds before the end.
                for (std::size_t i = ways.size() - 20; i < ways.size(); ++i)
                    ASSERT_TRUE(flat.isBeside(ways[i], flat.boxes[box]))
                        << "flat " << seed << ", " << event.text << " at " << ways[i].x << ','
                        << ways[i].y;
            }
        }
        EXPECT_EQ(next, static_cast<std::int64_t>(2 * flat.boxes.size())) << "flat " << seed;
    }
    EXPECT_GT(done, 600);
    EXPECT_GT(given_up, 50);
}

TEST(ActivityDirector, WhoIsLedAwayDoesNotUse) {
    Lived day("at 00:00 a uses sofa 1h\n", flat("open=yes"));
    day.run(60);
    ASSERT_EQ(day.events().size(), 1U);
    MotionPlan away;
    away.path = {{-2, 0}};
    day.world.command(0, pathCommand(away));
    day.run(20);
    EXPECT_EQ(day.events(), (std::vector<std::string>{"+a uses_sofa_1h: uses sofa 1h",
                                                      "!a uses_sofa_1h: uses sofa 1h"}));
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

/// Ways of a crowd take turns, the same ones in each run; no one is left behind.
TEST(ActivityDirector, ACrowdSetsOutInTurns) {
    std::string people, script;
    constexpr int kPeople = 150;
    for (int i = 0; i < kPeople; ++i) {
        const std::string id = "p" + std::to_string(i);
        people += "human id=" + id + " at=" + formatDouble(-18 + 0.6 * (i % 30)) + ',' +
                  formatDouble(-10 + 0.6 * (i / 30)) + '\n';
        script += "at 00:00 " + id + " goes far\n";
    }
    const Scene hall = testing::scene("ispace size=40,24\nzone id=far at=0,8 size=38,6\n", people);
    std::vector<int> underway;
    for (int run = 0; run < 2; ++run) {
        Lived day(script, hall, milliseconds(20));
        for (int step = 0; step < 150; ++step) {
            day.run(1);
            int count = 0;
            for (std::size_t i = 0; i < kPeople; ++i) count += day.world.running(i) > 0 ? 1 : 0;
            if (run == 0)
                underway.push_back(count);
            else
                ASSERT_EQ(count, underway[static_cast<std::size_t>(step)]) << step;
        }
    }
    EXPECT_GT(underway[0], 0);
    EXPECT_LT(underway[0], kPeople / 2) << "all in one step";
    EXPECT_GT(underway.back(), kPeople * 9 / 10);
}

/// Ways of each height are searched once, which takes a tenth of a second of the limit.
TEST(ActivityDirector, WaysOfManyKindsOfPeopleAreKept) {
    std::string zones, people, script;
    constexpr int kPeople = 20;
    for (int i = 0; i < kPeople; ++i) {
        const std::string id = "p" + std::to_string(i), x = formatDouble(-18 + 1.8 * i);
        people.append("human id=").append(id).append(" at=").append(x).append(",-8 height=");
        people.append(formatDouble(1.5 + 0.01 * i)).append("\n");
        zones.append("zone id=f").append(id).append(" at=").append(x).append(",-4 size=1,1\n");
        zones.append("zone id=n").append(id).append(" at=").append(x).append(",-8 size=1,1\n");
        script.append("at 00:00 ").append(id).append(" goes f").append(id).append("\n");
        script.append("at 00:02 ").append(id).append(" goes n").append(id).append("\n");
    }
    const Scene hall = testing::scene("ispace size=40,24\n" + zones, people);
    Lived day(script, hall, milliseconds(100));
    const auto underway = [&] {
        int count = 0;
        for (std::size_t i = 0; i < kPeople; ++i) count += day.world.running(i) > 0 ? 1 : 0;
        return count;
    };
    day.run(5);
    EXPECT_LT(underway(), kPeople / 2);
    day.run(1190);
    EXPECT_EQ(underway(), 0);
    day.run(8);
    EXPECT_EQ(underway(), kPeople);
}

/// A closet whose ways are soon searched, and a long way behind its door.
TEST(ActivityDirector, ACrowdGivesUpInTurns) {
    std::string people, script;
    constexpr int kPeople = 30;
    for (int i = 0; i < kPeople; ++i) {
        const std::string id = "p" + std::to_string(i);
        const int row = i / 6;
        people += "human id=" + id + " at=" + formatDouble(-18 + 0.6 * (i % 6)) + ',' +
                  formatDouble(-10 + 0.6 * row) + '\n';
        script += "at 00:00 " + id + " goes far\n";
    }
    const Scene hall = testing::scene(
        "ispace size=40,24\nwall id=v from=-14,-12 to=-14,-6\nwall id=h from=-20,-6 to=-14,-6\n"
        "door id=d wall=v offset=3\ninside at=-15,-7\ninside at=0,0\n"
        "zone id=far at=18,10 size=2,2\n",
        people);
    Lived day(script, hall, milliseconds(100));
    day.simulation.events().want({EventKind::Unreached});
    day.simulation.events().unwant({EventKind::Activity});
    const EventLog& log = day.simulation.events();
    std::int64_t most = 0;
    for (int step = 0; step < 200; ++step) {
        const std::int64_t before = log.next();
        day.run(1);
        most = std::max(most, log.next() - before);
    }
    EXPECT_LE(most, kPeople / 2);
    ASSERT_EQ(log.next(), kPeople);
    for (std::int64_t i = 0; i < kPeople; ++i) EXPECT_EQ(log.at(i).text, "d is shut") << i;
}

}  // namespace activity_test
}  // namespace ispace::days
