// SPDX-License-Identifier: GPL-3.0-or-later
// Lasers that spin, on moving robots and among moving people, against closed forms.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/mover.h"
#include "sim/odometry.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace spin_test {

using std::chrono::milliseconds;
using testing::scene;

constexpr SimTime kStep = milliseconds(5);
const std::string kRoom = "ispace size=8,6\n";

/// Distance to the walls of the room, which has its middle at 0,0.
double rangeInRoom(Point2 from, Vec2 way) {
    const auto leave = [](double place, double step, double half) {
        return step == 0 ? 1e9 : ((step > 0 ? half : -half) - place) / step;
    };
    return std::min(leave(from.x, way.x, 4), leave(from.y, way.y, 3));
}

/// Goes on until the laser has read a scan that began at or after a time.
const Scan& scanFrom(World& world, std::size_t laser, SimTime begin) {
    do {
        world.step();
    } while (world.reading(laser).time < begin);
    return world.reading(laser).scan();
}

TEST(Spin, OfATurningRobotEachBeamIsOfItsTime) {
    for (const int spin : {10, -10}) {
        const Scene room = scene(kRoom,
                                 "robot id=r1 at=-1,0.5\n"
                                 "laser on=r1 at=0.2,0.1 fov=270 step=0.5 range=20 spin=" +
                                     std::to_string(spin) + "\n");
        World world(room, kStep);
        world.command(0, {Verb::Rotspeed, 90});
        for (int i = 0; i < 400; ++i) world.step();
        const double now = seconds(world.time()), heading = world.status(0).pose.heading.degrees();
        const Scan& scan = scanFrom(world, 0, world.time());
        const Laser& laser = std::get<Laser>(world.sensors()[0].model);
        double moved = 0;
        for (int k = 0; k < laser.beams; ++k) {
            const double later = laser.timeOf(k);
            const Angle turned = Angle::degrees(heading + 90 * (scan.time + later - now));
            const Point2 place = Pose2{{-1, 0.5}, turned} * Point2{0.2, 0.1};
            const double exact = rangeInRoom(place, unitVector(turned + laser.bearing(k)));
            EXPECT_NEAR(scan.ranges[static_cast<std::size_t>(k)], exact, 1e-6 * exact) << k;
            const Angle start = Angle::degrees(heading + 90 * (scan.time - now));
            const Point2 first = Pose2{{-1, 0.5}, start} * Point2{0.2, 0.1};
            const double still = rangeInRoom(first, unitVector(start + laser.bearing(k)));
            moved = std::max(moved, std::abs(still - exact));
        }
        EXPECT_GT(moved, 0.3) << "motion matters here";
    }
}

TEST(Spin, TowardsAWallAtConstantSpeed) {
    const Scene room = scene(kRoom, "robot id=r1 at=-3,0\nlaser on=r1 fov=180 range=20 spin=10\n");
    World world(room, kStep);
    world.command(0, {Verb::Speed, 1});
    for (int i = 0; i < 700; ++i) world.step();
    const double now = seconds(world.time()), x = world.status(0).pose.position.x;
    const Scan& scan = scanFrom(world, 0, world.time());
    for (int k = 0; k <= 180; ++k) {
        const Point2 place{x + (scan.time + k / 3600.0 - now), 0};
        const double exact = rangeInRoom(place, unitVector(Angle::degrees(k - 90)));
        EXPECT_NEAR(scan.ranges[static_cast<std::size_t>(k)], exact, 1e-6) << k;
    }
}

TEST(Spin, AScanIsReadWithItsLastBeamAndHasTheTimeOfTheFirst) {
    // 270 of 360 degrees at 10 Hz: 75 ms.
    const Scene room =
        scene(kRoom, "laser id=a at=0,0 fov=270 spin=10\nlaser id=b at=0,0 fov=270\n");
    World world(room, kStep);
    EXPECT_EQ(world.latestReadings().size(), 2U) << "the first ones are of one moment";
    for (int i = 1; i <= 200; ++i) {
        world.step();
        const bool begins = i % 20 == 0, ends = i > 20 && i % 20 == 15;
        ASSERT_EQ(world.latestReadings().size(), begins || ends ? 1U : 0U) << i;
        if (begins) {
            ASSERT_EQ(world.reading(1).time, i * kStep);
        }
        if (!ends) continue;
        ASSERT_EQ(world.latestReadings()[0], 0U);
        EXPECT_EQ(world.reading(0).time, (i - 15) * kStep);
        EXPECT_EQ(world.reading(0).seq, i / 20);
        EXPECT_EQ(world.reading(0).scan().time, seconds((i - 15) * kStep));
        EXPECT_EQ(world.reading(0).scan().ranges, world.reading(1).scan().ranges)
            << "where nothing moves";
    }
}

TEST(Spin, RatesThatDoNotFitTheSteps) {
    const Scene room =
        scene(kRoom,
              "laser id=a at=0,0 model=rplidar-a1\nlaser id=b at=0,0 model=lms200\n"
              "laser id=c at=0,0 rate=5.5 beams=3\nlaser id=d at=0,0 rate=75 beams=3\n");
    for (const SimTime step : {milliseconds(5), milliseconds(7), milliseconds(100)}) {
        World world(room, step);
        std::map<std::size_t, std::vector<std::pair<std::int64_t, SimTime>>> read;
        for (int i = 0; i < 2000; ++i) {
            world.step();
            for (const std::size_t sensor : world.latestReadings())
                read[sensor].push_back({world.reading(sensor).seq, world.reading(sensor).time});
        }
        // The same scans as of lasers that read at once, but for the last.
        for (const std::size_t spinning : {0, 1}) {
            auto& at_once = read[spinning + 2];
            ASSERT_LE(at_once.size() - read[spinning].size(), 2U);
            at_once.resize(read[spinning].size());
            EXPECT_EQ(read[spinning], at_once) << spinning;
        }
    }
}

TEST(Spin, AWallLaserSeesAPersonWhereSheIsThen) {
    // A robot drives across the view, 2 m ahead of the laser: where its flank is seen gives away
    // its place at that time.
    const Scene room = scene(kRoom,
                             "robot id=r1 at=0,-2.5 heading=90 radius=0.3 height=1\n"
                             "laser id=l1 at=-2,0 fov=180 step=0.125 range=20 spin=5 rate=5\n");
    World world(room, kStep);
    world.command(0, {Verb::Speed, 1.2});
    int seen = 0;
    for (int i = 0; i < 900; ++i) {
        world.step();
        if (world.latestReadings().empty()) continue;
        const Scan& scan = world.reading(0).scan();
        for (std::size_t k = 1; k < scan.ranges.size(); ++k) {
            // The first beam that meets the cylinder, on its right side.
            if (scan.ranges[k] > 2.2F || scan.ranges[k - 1] < 2.2F) continue;
            const auto& laser = std::get<Laser>(world.sensors()[0].model);
            const double t = scan.time + laser.timeOf(static_cast<int>(k));
            // The status is that of now; its speed has been constant for long.
            const double y = world.status(0).pose.position.y -
                             world.status(0).speed * (seconds(world.time()) - t);
            if (world.status(0).accel != 0 || world.status(0).speed < 1.19) continue;
            const double edge = std::atan2(y, 2) - std::asin(0.3 / std::hypot(y, 2));
            const double bearing = laser.bearing(static_cast<int>(k)).radians();
            // A step is 5 ms: bodies are where they were in the nearest one.
            EXPECT_NEAR(bearing, edge, 0.125 * std::acos(-1) / 180 + 1.2 * 0.0025 / 2);
            ++seen;
        }
    }
    EXPECT_GT(seen, 2);
}

TEST(Spin, ASweepTurnsOnWhileItScans) {
    const Scene room = scene(kRoom,
                             "laser at=0,0 fov=359 range=20 rate=10 spin=10 sweep=heading "
                             "sweep_step=10\n");
    World world(room, kStep);
    const Scan& scan = scanFrom(world, 0, milliseconds(100));
    EXPECT_EQ(scan.number, 1);
    for (int k = 0; k < 360; ++k)
        EXPECT_NEAR(scan.ranges[static_cast<std::size_t>(k)],
                    rangeInRoom({0, 0}, unitVector(Angle::degrees(10 + k / 36.0 - 179.5 + k))),
                    1e-5);
}

TEST(Spin, GoesOnWhileTheWorldIsChanged) {
    const std::string things =
        "robot id=r1 at=-1,0.5\nlaser id=l1 on=r1 fov=270 step=0.5 range=20 spin=10\n";
    const Scene room = scene(kRoom, things);
    const Scene more = scene(kRoom, "robot id=r0 at=3.5,-2.5 radius=0.1 height=0.1\n" + things);
    World changed(room, kStep), whole(room, kStep);
    for (World* world : {&changed, &whole}) world->command(0, {Verb::Rotspeed, 90});
    for (int i = 1; i <= 230; ++i) {
        // A person too low to be seen enters during a scan, which shifts the indices of others.
        if (i == 205) changed.change(more);
        changed.step();
        whole.step();
        ASSERT_EQ(changed.reading(0).time, whole.reading(0).time) << i;
        ASSERT_EQ(changed.reading(0).scan().ranges, whole.reading(0).scan().ranges) << i;
    }
}

TEST(Spin, TheSameForAnyNumberOfThreads) {
    std::string things;
    for (int i = 0; i < 8; ++i) {
        const std::string id = std::to_string(i), at = std::to_string(i - 3.5);
        things += "robot id=r" + id + " at=" + at + ",-1 walk=wander\n";
        things += "laser on=r" + id + " model=urg-04lx\n";
        things += "human id=h" + id + " at=" + at + ",1 walk=wander\n";
    }
    const Scene room = scene(kRoom, things);
    std::vector<std::vector<std::vector<float>>> runs;
    for (const std::size_t threads : {1, 2}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        World world(room, kStep, {.seed = 3, .sensor_noise = true});
        runs.emplace_back();
        for (int i = 0; i < 300; ++i) {
            world.step();
            for (const std::size_t sensor : world.latestReadings())
                runs.back().push_back(world.reading(sensor).scan().ranges);
        }
    }
    EXPECT_GT(runs[0].size(), 50U);
    EXPECT_EQ(runs[0], runs[1]);
}

TEST(PoseHistory, ALongOneStaysSmall) {
    // A scan of a hundred seconds in steps of a millisecond.
    PoseHistory trail(std::chrono::seconds(100));
    std::vector<Motion> robots(1);
    for (int i = 0; i <= 200'000; ++i) {
        robots[0].pose.position.x = i * 1e-3;
        trail.add(milliseconds(i), {robots, {}, {}}, true);
    }
    EXPECT_LE(trail.size(), 2U * 4096 + 3);
    PoseHistory::Walk walk(trail, milliseconds(100'000));
    for (double later = 0; later <= 100; later += 0.37) {
        walk.to(later);
        const ArcPath way(walk.from().robots[0], walk.to().robots[0]);
        EXPECT_NEAR(way.at(walk.share().at(later)).position.x, 100 + later, 1e-9);
    }
}

TEST(PoseHistory, StandsWhereNothingMoves) {
    PoseHistory trail(milliseconds(100));
    std::vector<Motion> robots(1);
    for (int i = 0; i <= 100; ++i) trail.add(milliseconds(i), {robots, {}, {}}, i == 50);
    EXPECT_TRUE(trail.isStillSince(milliseconds(50)));
    EXPECT_FALSE(trail.isStillSince(milliseconds(49)));
}

}  // namespace spin_test
}  // namespace ispace
