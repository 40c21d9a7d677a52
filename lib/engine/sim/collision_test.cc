// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "geom/predicates.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {

namespace collision_test {

Polygon square(Point2 center, double half) {
    const auto [x, y] = center;
    return {{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
}

/// A room of 10 m with a sheet along x = 2 from y = 0 on, and a closed square of 2 m at -2,-2.
Slice room() {
    Slice band;
    forEachEdge(square({0, 0}, 5), [&](const Segment2& line) { band.sheets.push_back(line); });
    band.sheets.push_back({{2, 0}, {2, 5}});
    band.solids.push_back(square({-2, -2}, 1));
    band.sheet_owners = {0, 0, 0, 0, 1};
    band.solid_owners = {2};
    return band;
}

/// A move with its own state; its robot turns at once, to make simple arcs.
struct Step {
    Motion from;
    MotionLimits limits = limitsOf({}, 0);
    Move move;

    Step(Point2 place, double heading, double speed, double rotspeed, double duration,
         double radius = 0.3) {
        from.pose = {place, Angle::degrees(heading)};
        from.drive = {.goal = {AxisGoal::Kind::Speed, speed}, .speed = speed};
        from.turn = {.goal = {AxisGoal::Kind::Speed, rotspeed}, .speed = rotspeed};
        limits.drive.max = limits.turn.max = 1e6;
        move = {.from = &from,
                .limits = &limits,
                .duration = duration,
                .radius = radius,
                .to = advance(from, limits, duration)};
    }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;
};

TEST(Collision, SegmentsHaveADistance) {
    const Segment2 s{{0, 0}, {2, 0}};
    EXPECT_EQ(distance(s, Segment2{{1, -1}, {1, 1}}), 0);
    EXPECT_EQ(distance(s, Segment2{{3, 0}, {4, 0}}), 1);
    EXPECT_EQ(distance(s, Segment2{{1, 2}, {5, 3}}), 2);
    EXPECT_EQ(distance(s, Segment2{{2, 0}, {2, 0}}), 0);
    EXPECT_EQ(distance(Segment2{{5, 4}, {5, 4}}, s), 5);
}

TEST(Collision, CirclesMayTouch) {
    const Obstacles obstacles(room());
    EXPECT_FALSE(obstacles.overlap({0, 0}, 0.3));
    EXPECT_FALSE(obstacles.overlap({1.7, 2}, 0.3));
    EXPECT_TRUE(obstacles.overlap({1.7 + 1e-8, 2}, 0.3));
    EXPECT_FALSE(obstacles.overlap({-4.7, -4.7}, 0.3));
    EXPECT_TRUE(obstacles.overlap({-4.71, 0}, 0.3));
    EXPECT_EQ(obstacles.overlap({2, -0.29}, 0.3), 1U);
    EXPECT_EQ(obstacles.overlap({-1.5, -2}, 0.2), 2U);
    // Within a solid, far from its edges.
    EXPECT_TRUE(obstacles.overlap({-2, -2}, 0.1));
    EXPECT_FALSE(Obstacles(Slice{}).overlap({0, 0}, 1));
}

TEST(Collision, NearestLineIsWhatAllSay) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-6, 6), extent(-1, 1);
    Slice band = room();
    for (int i = 0; i < 200; ++i) {
        const Point2 a{place(random), place(random)};
        band.sheets.push_back({a, a + Vec2{extent(random), extent(random)}});
        band.sheet_owners.push_back(3);
    }
    const Obstacles obstacles(band);
    EXPECT_EQ(Obstacles(Slice{}).nearest({0, 0}, 1.3), 1.3);
    for (int i = 0; i < 500; ++i) {
        const Point2 p{1.5 * place(random), 1.5 * place(random)};
        const Segment2 way{p, p + Vec2{extent(random), extent(random)}};
        double nearest = 1.3, least = 1e9;
        band.forEachLine([&](const Segment2& line) {
            nearest = std::min(nearest, distance(p, line));
            least = std::min(least, distance(way, line));
        });
        EXPECT_EQ(obstacles.nearest(p, 1.3), nearest);
        EXPECT_FALSE(obstacles.near(way, least));
        EXPECT_TRUE(obstacles.near(way, least + 1e-9));
    }
}

TEST(Collision, StraightMovesStopAtThings) {
    const Obstacles obstacles(room());
    EXPECT_FALSE(collides(Step({0, 2}, 0, 1.7, 0, 1).move, obstacles));
    EXPECT_EQ(collides(Step({0, 2}, 0, 1.7001, 0, 1).move, obstacles), 1U);
    // Through a sheet in one step, from far and to far.
    EXPECT_TRUE(collides(Step({1, 2}, 0, 2.5, 0, 1).move, obstacles));
    EXPECT_TRUE(collides(Step({2.9, -2}, 180, 4, 0, 1).move, obstacles));
    // Past the end of the sheet.
    EXPECT_FALSE(collides(Step({1, -0.3}, 0, 2, 0, 1).move, obstacles));
    EXPECT_TRUE(collides(Step({1, -0.29}, 0, 2, 0, 1).move, obstacles));
}

TEST(Collision, WhoTouchesMayLeaveAndPass) {
    const Obstacles obstacles(room());
    for (const double heading : {90, 180, 270, 135, 225}) {
        EXPECT_FALSE(collides(Step({1.7, 2}, heading, 0.5, 0, 1).move, obstacles));
        // Within the wall by rounding.
        EXPECT_FALSE(collides(Step({1.7 + 1.1e-9, 2}, heading, 0.5, 0, 1).move, obstacles));
    }
    EXPECT_TRUE(collides(Step({1.7, 2}, 80, 0.5, 0, 1).move, obstacles));
    EXPECT_TRUE(collides(Step({1.7, 2}, 0, 1e-4, 0, 1).move, obstacles));
}

TEST(Collision, ArcsAreNotTheirChords) {
    const Obstacles obstacles(room());
    // A half circle to the left of 0.5 m radius, from 1.3,2 up and back: its top is at x + 0.5.
    const double rate = 180, speed = 0.5 * Angle::degrees(rate).radians();
    EXPECT_FALSE(collides(Step({1.19, 2}, 0, speed, rate, 1).move, obstacles));
    EXPECT_TRUE(collides(Step({1.25, 2}, 0, speed, rate, 1).move, obstacles));
    // Back and forth: the chord is a point.
    Motion from;
    from.pose.position = {1.6, 2};
    from.drive = {.goal = {AxisGoal::Kind::Speed, -9}, .speed = 0.6};
    MotionLimits limits = limitsOf({}, 0);
    limits.drive = {.top = 9, .max = 9, .accel = 1.2};
    const Move back{.from = &from,
                    .limits = &limits,
                    .duration = 1,
                    .radius = 0.3,
                    .to = advance(from, limits, 1)};
    EXPECT_NEAR(distance(back.start(), back.end()), 0, 1e-12);
    EXPECT_TRUE(collides(back, obstacles));
    from.pose.position = {1.5, 2};
    const Move beside{.from = &from,
                      .limits = &limits,
                      .duration = 1,
                      .radius = 0.3,
                      .to = advance(from, limits, 1)};
    EXPECT_FALSE(collides(beside, obstacles));
}

TEST(Collision, RobotsMeet) {
    const Step east({0, 0}, 0, 1, 0, 1), west({2, 0}, 180, 1, 0, 1);
    const Step same({-0.7, 0}, 0, 1, 0, 1), slow({-0.7, 0}, 0, 0.5, 0, 1);
    EXPECT_TRUE(collides(east.move, west.move, true));
    EXPECT_FALSE(collides(east.move, west.move, false));
    EXPECT_TRUE(collides(same.move, east.move, false));
    EXPECT_FALSE(collides(same.move, east.move, true));
    EXPECT_FALSE(collides(slow.move, east.move, true));
    // Their ways cross at different times, and at the same.
    const Step north({1, -1}, 90, 1, 0, 1), late({0.99, -1.99}, 90, 1, 0, 1);
    EXPECT_TRUE(collides(north.move, east.move, true));
    EXPECT_FALSE(collides(late.move, east.move, true));
    // Touching is allowed, and to leave.
    const Step touching({0.6, 0}, 0, 1, 0, 1), into({0.6, 0}, 180, 1e-3, 0, 1);
    EXPECT_FALSE(collides(touching.move, east.move, false));
    EXPECT_TRUE(collides(into.move, east.move, false));
    // The same for those that overlap by rounding.
    const Step within({0.6 - 1.1e-9, 0}, 0, 1, 0, 1), along({0.6 - 1.1e-9, 0}, 90, 1, 0, 1);
    EXPECT_FALSE(collides(within.move, east.move, false));
    EXPECT_FALSE(collides(along.move, east.move, false));
}

TEST(Collision, CurvedWaysOfRobotsMeetAsFineStepsDo) {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> place(-1.2, 1.2), any(-180, 180), speed(-1, 1);
    int hits = 0, misses = 0;
    for (int i = 0; i < 2000; ++i) {
        const Step a({0, 0}, any(random), speed(random), any(random), 1);
        const Step b({place(random), place(random)}, any(random), speed(random), any(random), 1);
        if (distance(a.move.start(), b.move.start()) < 0.6) continue;
        double least = 1e9;
        for (int k = 0; k <= 200; ++k) {
            const Point2 p = advance(a.from, a.limits, k / 200.0).motion.pose.position;
            const Point2 q = advance(b.from, b.limits, k / 200.0).motion.pose.position;
            least = std::min(least, distance(p, q));
        }
        const bool hit = collides(a.move, b.move, true);
        if (least < 0.595) {
            ++hits;
            EXPECT_TRUE(hit) << i;
        } else if (least > 0.605) {
            ++misses;
            EXPECT_FALSE(hit) << i;
        }
    }
    EXPECT_GT(hits, 100);
    EXPECT_GT(misses, 100);
}

TEST(Collision, ACancelledMoveStays) {
    Step step({1, 1}, 0, 1, 20, 1);
    step.move.cancel();
    EXPECT_EQ(step.move.end(), (Point2{1, 1}));
    EXPECT_EQ(step.move.to.motion.pose, step.from.pose);
    EXPECT_TRUE(step.move.to.motion.arrived());
    EXPECT_EQ(step.move.to.path, 0);
    EXPECT_EQ(step.move.place(5), (Point2{1, 1}));
}

TEST(Collision, PeopleStandBesideEachOther) {
    const auto start = [](const std::string& layout) {
        const Scene scene = testing::scene("ispace size=8,6\n", layout);
        const World world(scene, std::chrono::milliseconds(5));
    };
    // 0.51 m wide, of which arms give way.
    EXPECT_NO_THROW(start("human at=0,0\nhuman at=0.47,0\n"));
    try {
        start("human id=a at=0,0\nhuman id=b at=0.4,0\nhuman id=c at=2,0\n");
        FAIL() << "two people in each other";
    } catch (const FormatError& error) {
        EXPECT_NE(std::string(error.what())
                      .find("human a overlaps human b near (0.2, 0.0); move one, e.g. by 0.11 m"),
                  std::string::npos)
            << error.what();
    }
    EXPECT_THROW(start("robot at=0,0\nhuman at=0.45,0\n"), FormatError) << "robots do not give way";
}

TEST(Collision, PairsThatCanMeetAreBounded) {
    std::vector<Mover> movers(2900);
    std::vector<Motion> motions(movers.size());
    for (std::size_t i = 0; i < movers.size(); ++i) {
        movers[i].model.radius = 0.01;
        motions[i].pose.position = {static_cast<double>(i) * 1e-3, 0};
    }
    EXPECT_THROW(checkCrowding(movers, motions, kMoverSight), FormatError);
    // A tenth of a metre apart, each has some eighty in sight.
    for (std::size_t i = 0; i < movers.size(); ++i)
        motions[i].pose.position = {static_cast<double>(i) * 0.1, 0};
    EXPECT_NO_THROW(checkCrowding(movers, motions, kMoverSight));
    EXPECT_THROW(checkCrowding(movers, motions, 300), FormatError) << "of fast movers";
}

}  // namespace collision_test

}  // namespace ispace
