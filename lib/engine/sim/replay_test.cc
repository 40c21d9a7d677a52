// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "sim/simulation.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {
namespace replay_test {

namespace fs = std::filesystem;
using std::chrono::hours;
using std::chrono::milliseconds;
using testing::scene;

constexpr SimTime kStep = milliseconds(20);
constexpr const char* kRoom = "ispace id=room size=8,6\npillar id=post at=2,0 size=0.2,0.2,2.5\n";
constexpr const char* kWho =
    "robot id=r1 at=0,0\nlaser id=l1 on=r1 range=4\nlaser id=l2 at=0,-2 heading=90\n"
    "human id=h1 at=1,2\n";

class ReplayTest : public ::testing::Test {
  protected:
    ReplayTest() { world_ = std::make_unique<World>(scene_, kStep); }
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

    /// r1 drives round a bend and into the post; four seconds.
    void record() {
        Recorder recorder(folder_.path(), *world_, {}, 0);
        world_->command(0, {.verb = Verb::Speed, .value = 1.2});
        world_->command(0, {.verb = Verb::Rotspeed, .value = 2});
        for (int i = 0; i < 200; ++i) {
            world_->step();
            recorder.record(*world_);
        }
        recorder.flush(*world_);
        fs::remove(path("events.csv"));  // never requested
    }

    Scene scene_ = scene(kRoom, kWho);
    testing::TestFolder folder_;
    std::unique_ptr<World> world_;
};

std::vector<float> rangesOf(const World& world, const char* laser) {
    return world.reading(world.sensorNamed(laser).value()).scan().ranges;
}

TEST_F(ReplayTest, GoesAsRecordedAndSeesTheSame) {
    record();
    ASSERT_TRUE(world_->status(0).stall);
    const std::vector<float> seen = rangesOf(*world_, "l1");
    Replay replay(folder_.path());
    EXPECT_EQ(replay.stepLength(), kStep);
    World again(scene_, kStep);
    int steps = 0, stalls = 0;
    for (; !replay.atEnd(); ++steps) {
        ASSERT_TRUE(replay.step(again));
        stalls += static_cast<int>(again.collisions().size());
    }
    EXPECT_FALSE(replay.step(again));
    EXPECT_FALSE(replay.isCut());
    EXPECT_EQ(steps, 200);
    EXPECT_EQ(stalls, 1);
    const RobotStatus then = world_->status(0), now = again.status(0);
    EXPECT_NEAR(distance(now.pose.position, then.pose.position), 0, 1e-12);
    EXPECT_NEAR(now.pose.heading.degrees(), then.pose.heading.degrees(), 1e-12);
    EXPECT_EQ(now.speed, then.speed);
    EXPECT_EQ(now.stall, then.stall);
    const std::vector<float> read = rangesOf(again, "l1");
    ASSERT_EQ(read.size(), seen.size());
    for (std::size_t i = 0; i < read.size(); ++i)
        EXPECT_TRUE(read[i] == seen[i] || std::abs(read[i] - seen[i]) < 1e-5F) << i;
}

TEST_F(ReplayTest, GoesOnInARoomWithoutMovers) {
    const Scene room = scene(kRoom, "laser id=l1 at=1,1\n");
    World world(room, kStep);
    {
        Recorder recorder(folder_.path(), world, {}, 0);
        for (int i = 0; i < 50; ++i) {
            world.step();
            recorder.record(world);
        }
        recorder.flush(world);
    }
    Replay replay(folder_.path());
    World again(room, kStep);
    int steps = 0;
    for (; !replay.atEnd(); ++steps) ASSERT_TRUE(replay.step(again));
    EXPECT_EQ(steps, 50);
    EXPECT_FALSE(replay.step(again));
    EXPECT_EQ(again.time(), world.time());
    EXPECT_EQ(again.reading(0).seq, world.reading(0).seq);
    replay.seek(again, 10 * kStep);
    EXPECT_EQ(again.time(), 10 * kStep);
    EXPECT_FALSE(replay.atEnd());
}

TEST_F(ReplayTest, GoesOnWithMoversThatTheRecordLacks) {
    const Scene room = scene(kRoom, "laser id=l1 at=1,1\n");
    World world(room, kStep);
    {
        Recorder recorder(folder_.path(), world, {}, 0);
        for (int i = 0; i < 20; ++i) {
            world.step();
            recorder.record(world);
        }
        recorder.flush(world);
    }
    Replay replay(folder_.path());
    World again(scene_, kStep);
    int steps = 0;
    while (replay.step(again)) ++steps;
    EXPECT_EQ(steps, 20);
    EXPECT_EQ(again.status(0).speed, 0);
}

/// A person that is stopped lowers its limbs: the laser sees that in the run, too.
TEST_F(ReplayTest, SeesTheLimbsOfThoseThatAreStopped) {
    const Scene room =
        scene("ispace size=8,6\n", "laser id=l1 at=-3,0,1 range=9\nhuman id=h at=3,0\n");
    World world(room, kStep);
    Recorder recorder(folder_.path(), world, {}, 0);
    world.command(0, {.verb = Verb::Forward, .value = 9});
    std::vector<std::vector<float>> seen;
    for (int i = 0; i < 150; ++i) {
        world.step();
        recorder.record(world);
        seen.push_back(rangesOf(world, "l1"));
    }
    recorder.flush(world);
    ASSERT_TRUE(world.status(0).stall);
    Replay replay(folder_.path());
    World again(room, kStep);
    for (int i = 0; i < 150; ++i) {
        ASSERT_TRUE(replay.step(again));
        ASSERT_EQ(rangesOf(again, "l1"), seen[static_cast<std::size_t>(i)]) << i;
    }
}

TEST_F(ReplayTest, KnowsWhoRanIntoWhom) {
    writeAll(path("robots.csv"),
             "t,id,x,y,heading_deg,stall\n0,r1,0,0,0,0\n0.02,r1,0,0,0,1\n0.04,r1,0,0,0,1\n");
    writeAll(path("people.csv"),
             "t,id,x,y,heading_deg,speed,phase,sidespeed,stall\n0,h1,1,2,0,0,0,0,0\n"
             "0.02,h1,1,2,0,1,0.25,0.3,0\n0.04,h1,1,2,0,0,0.5,0,1\n");
    const auto into = [this] {
        Replay replay(folder_.path());
        World world(scene_, kStep);
        std::string all;
        while (replay.step(world))
            for (const Collision& each : world.collisions())
                all += world.movers()[each.robot].id + '>' + std::string(each.into) + ' ';
        return all;
    };
    EXPECT_EQ(into(), "r1>something h1>something ") << "by their stalls";
    writeAll(path("events.csv"),
             "t,kind,id,other,x,y,value,text\n0.02,collision,r1,h1,0,0,,\n0.04,stall,h1,,0,0,,\n");
    EXPECT_EQ(into(), "r1>h1 ") << "by the events";
    Replay replay(folder_.path());
    World world(scene_, kStep);
    ASSERT_TRUE(replay.step(world));
    EXPECT_EQ(world.collisions()[0].other, 1U);
    EXPECT_EQ(world.status(1).phase, 0.25);
    EXPECT_EQ(world.status(1).sidespeed, 0.3);
}

TEST_F(ReplayTest, EndsTheRunOrHolds) {
    record();
    Replay replay(folder_.path());
    World world(scene_, kStep);
    Simulation simulation(world, {}, {Clock::Kind::Fast, 1}, {});
    simulation.replay(replay, false);
    EXPECT_TRUE(simulation.isReplay());
    simulation.run(WallTime(), hours(1));
    EXPECT_TRUE(simulation.finished());
    EXPECT_EQ(world.steps(), 200);

    Replay held(folder_.path());
    World held_world(scene_, kStep);
    Simulation holding(held_world, {}, {Clock::Kind::Fast, 1}, {});
    holding.replay(held, true);
    holding.run(WallTime(), hours(1));
    EXPECT_FALSE(holding.finished());
    EXPECT_TRUE(holding.isHeld());
    EXPECT_TRUE(holding.paused());
    holding.allow(5);
    EXPECT_EQ(holding.owed(), 0);
    holding.resume(WallTime());
    EXPECT_TRUE(holding.paused());
    EXPECT_EQ(holding.run(WallTime(), hours(1)), std::nullopt);
    EXPECT_EQ(held_world.steps(), 200);
}

TEST_F(ReplayTest, BeginsWhereTheRecordDoes) {
    writeAll(path("robots.csv"), "t,id,x,y,heading_deg\n0,r1,0.25,-1,90\n0.02,r1,0.25,-0.9,90\n");
    const Replay replay(folder_.path());
    EXPECT_EQ(replay.stepLength(), kStep) << "by the moments";
    replay.placeAtStart(scene_);
    EXPECT_EQ(scene_.robots[0].pose, (Pose2{{0.25, -1}, Angle::degrees(90)}));
    EXPECT_NEAR(scene_.sensors[0].pose.position.x, 0.25, 1e-12);
    Scene other = scene(kRoom, "robot id=r2 at=0,0\n");
    EXPECT_THROW(replay.placeAtStart(other), FormatError);
}

std::string errorOf(const std::string& folder, const Scene& room) {
    try {
        Replay replay(folder);
        World world(room, replay.stepLength());
        while (replay.step(world)) continue;
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

TEST_F(ReplayTest, RefusesWhatIsNoRun) {
    const std::string header = "t,id,x,y,heading_deg\n", name = path("robots.csv");
    const auto errorWith = [&](const std::string& rows) {
        writeAll(name, header + rows);
        return errorOf(folder_.path(), scene_);
    };
    EXPECT_EQ(errorWith(""),
              name + ": error: holds no moment of a run, and no info.csv tells how long that was");
    EXPECT_EQ(errorWith("1,r1,0,0,0\n"),
              name +
                  ": error: begins at t=1 with steps of 0.005 s, wanted 0 and from 0.000001 to "
                  "1 s");
    EXPECT_EQ(errorWith("0,r1,0,0,0\n5,r1,0,0,0\n"),
              name + ": error: begins at t=0 with steps of 5 s, wanted 0 and from 0.000001 to 1 s");
    EXPECT_EQ(errorWith("0,r1,0,0,0\n0.1,r1,0,0,0\n0.3,r1,0,0,0\n"),
              name + ": error: goes on at t=0.3, wanted t=0.2");
    EXPECT_EQ(errorWith("0,r1,0,0,0\n0.1,r1,0,0,0\n0.2,r1,0\n").substr(0, name.size() + 8),
              name + ":4: erro");
    EXPECT_EQ(errorWith("0,r1,0,0,0\n0.1,r1,0,0,0\n0.2,r1,0"), "");
}

TEST_F(ReplayTest, PassesTimesWithoutAnybody) {
    const std::string header = "t,id,x,y,heading_deg\n",
                      events = "t,kind,id,other,x,y,value,text\n";
    writeAll(path("robots.csv"),
             header + "0,r1,0,0,0\n0.02,r1,0.01,0,0\n0.1,r1,0.5,0,0\n0.12,r1,0.51,0,0\n");
    writeAll(path("events.csv"), events + "0.02,mark,,,,,,none\n");
    EXPECT_EQ(errorOf(folder_.path(), scene_),
              path("robots.csv") + ": error: goes on at t=0.1, wanted t=0.04");
    writeAll(path("events.csv"),
             events + "0.02,change,,,,,,DELETE id=r1\n0.1,change,,,,,,ADD robot id=r1\n");
    Replay replay(folder_.path());
    EXPECT_EQ(replay.changedAt(), kStep);
    World world(scene_, kStep);
    std::string way;
    while (replay.step(world)) way += formatDouble(world.status(0).pose.position.x) + ' ';
    EXPECT_EQ(way, "0.01 0.01 0.01 0.01 0.5 0.51 ");
    EXPECT_EQ(world.steps(), 6);

    // Off the grid of steps it is no such time.
    writeAll(path("robots.csv"), header + "0,r1,0,0,0\n0.02,r1,0,0,0\n0.09,r1,0,0,0\n");
    EXPECT_EQ(errorOf(folder_.path(), scene_),
              path("robots.csv") + ": error: goes on at t=0.09, wanted t=0.04");
}

TEST_F(ReplayTest, OdometryAndNoiseAreThoseOfThen) {
    const Scene noisy = scene(kRoom,
                              "robot id=r1 at=0,0 path=1,1;-1,-1 motion_noise=0.1,0.1,0.1,0.1\n"
                              "laser id=l1 on=r1 range=4 sigma=0.05\nrobot id=r2 at=-2,-2\n");
    World world(noisy, kStep, {.seed = 5, .noise = true, .sensor_noise = true});
    std::vector<Odometry> believed;
    std::vector<std::vector<float>> ranges;
    {
        Recorder recorder(folder_.path(), world, {.seed = 5, .odometry = true, .noise = true});
        for (int i = 0; i < 100; ++i) {
            world.step();
            recorder.record(world);
            believed.push_back(world.odometry(0));
            ranges.push_back(rangesOf(world, "l1"));
        }
    }
    Replay replay(folder_.path());
    EXPECT_TRUE(replay.hasOdometry());
    EXPECT_EQ(replay.info().seed, 5U);
    ASSERT_TRUE(replay.info().noise);
    World again(noisy, kStep, {.seed = 5, .sensor_noise = true});
    for (std::size_t i = 0; replay.step(again); ++i) {
        const Odometry odometry = again.odometry(0);
        ASSERT_EQ(odometry.pose, believed[i].pose) << i;
        ASSERT_EQ(odometry.covariance, believed[i].covariance) << i;
        ASSERT_EQ(odometry.alphas, believed[i].alphas);
        ASSERT_EQ(odometry.speed, believed[i].speed);
        ASSERT_EQ(rangesOf(again, "l1"), ranges[i]) << i;
    }
    EXPECT_NE(again.odometry(0).pose.position, again.status(0).pose.position);
}

TEST_F(ReplayTest, WheelsRollAlongTheRecordedPoses) {
    const Scene room = scene(kRoom, "robot id=r1 at=0,0 path=1,1;-1,-1 loop=yes\n");
    World world(room, kStep);
    {
        Recorder recorder(folder_.path(), world, {});
        for (int i = 0; i < 2000; ++i) {
            world.step();
            recorder.record(world);
        }
    }
    Replay replay(folder_.path());
    World again(room, kStep);
    while (replay.step(again)) continue;
    EXPECT_GT(std::abs(world.wheelTravel(0).driven), 1);
    EXPECT_EQ(again.wheelTravel(0).driven, world.wheelTravel(0).driven);
    EXPECT_EQ(again.wheelTravel(0).turned, world.wheelTravel(0).turned);
}

TEST_F(ReplayTest, SeeksBackAndForth) {
    record();
    // As step by step, whatever was sought before.
    std::vector<RobotStatus> states;
    std::vector<std::vector<float>> ranges;
    {
        Replay replay(folder_.path());
        World world(scene_, kStep);
        do {
            states.push_back(world.status(0));
            ranges.push_back(rangesOf(world, "l1"));
        } while (replay.step(world));
    }
    Replay replay(folder_.path());
    EXPECT_EQ(replay.end(), 200 * kStep);
    World world(scene_, kStep);
    for (const int step : {150, 20, 21, 199, 0, 200}) {
        const auto i = static_cast<std::size_t>(step);
        const std::int64_t changes = world.changes();
        const bool is_back = step < world.steps();
        replay.seek(world, step * kStep + kStep / 2);
        EXPECT_EQ(world.steps(), step);
        EXPECT_EQ(world.status(0).pose, states[i].pose) << step;
        EXPECT_EQ(rangesOf(world, "l1"), ranges[i]) << step;
        EXPECT_EQ(world.changes() > changes, is_back) << "indices may be others";
    }
    EXPECT_TRUE(replay.atEnd());
    replay.seek(world, hours(1));
    EXPECT_EQ(world.steps(), 200);
    replay.seek(world, kStep);
    EXPECT_TRUE(replay.step(world));
    EXPECT_EQ(world.status(0).pose, states[2].pose);
}

TEST_F(ReplayTest, SeeksIntoTheMidstOfScans) {
    scene_ = scene(kRoom,
                   "robot id=r1 at=0,0\nhuman id=h1 at=1,2\nlaser id=l1 on=r1 fov=270 spin=10\n"
                   "laser id=l2 at=0,-2 heading=90 model=rplidar-a1\n");
    world_ = std::make_unique<World>(scene_, kStep);
    record();
    std::vector<SimTime> times;
    std::vector<std::vector<float>> ranges;
    {
        Replay replay(folder_.path());
        World world(scene_, kStep);
        do {
            times.push_back(world.reading(1).time);
            ranges.push_back(rangesOf(world, "l1"));
            ranges.push_back(rangesOf(world, "l2"));
        } while (replay.step(world));
    }
    Replay replay(folder_.path());
    World world(scene_, kStep);
    for (const int step : {150, 3, 20, 21, 187, 0, 200}) {
        const auto i = static_cast<std::size_t>(step);
        replay.seek(world, step * kStep);
        EXPECT_EQ(world.reading(1).time, times[i]) << step;
        EXPECT_EQ(rangesOf(world, "l1"), ranges[2 * i]) << step;
        EXPECT_EQ(rangesOf(world, "l2"), ranges[2 * i + 1]) << step;
    }
}

TEST_F(ReplayTest, ServesSonarsAndBumpersAgain) {
    // r1 meets the post with its front, backs off, and turns.
    scene_ = scene(kRoom,
                   "robot id=r1 model=create3 at=1.5,0.05\nrobot id=r2 model=pioneer-2dx at=0,2\n");
    world_ = std::make_unique<World>(scene_, kStep);
    std::vector<std::vector<bool>> felt;
    std::vector<std::vector<float>> heard;
    const auto look = [&](World& world) {
        felt.push_back(world.bumper(0));
        heard.push_back(world.sonar(1));
    };
    {
        Recorder recorder(folder_.path(), *world_, {.sonar_rate = 5});
        world_->command(0, {Verb::Forward, 1});
        world_->command(1, {Verb::Speed, 0.5});
        for (int i = 0; i < 200; ++i) {
            look(*world_);
            if (i == 150) world_->command(0, {Verb::Backward, 0.1});
            world_->step();
            recorder.record(*world_);
        }
        look(*world_);
    }
    const std::string bumpers = readAll(path("bumpers.csv")), sonars = readAll(path("sonars.csv"));
    EXPECT_TRUE(bumpers.starts_with("t,id,hit\n0,r1,0;0;0;0;0\n")) << bumpers;
    EXPECT_EQ(std::count(bumpers.begin(), bumpers.end(), '\n'), 5) << bumpers;
    EXPECT_NE(bumpers.find('1', bumpers.find("\n0,")), std::string::npos);
    EXPECT_EQ(std::count(sonars.begin(), sonars.end(), '\n'), 1 + 21) << "0 to 4 s, five a second";
    EXPECT_TRUE(std::any_of(felt.begin(), felt.end(), [](const std::vector<bool>& hit) {
        return std::find(hit.begin(), hit.end(), true) != hit.end();
    }));

    Replay replay(folder_.path());
    World world(scene_, kStep);
    const std::string again = path("again");
    {
        Recorder recorder(again, world, {.sonar_rate = 5});
        std::size_t i = 0;
        do {
            ASSERT_EQ(world.bumper(0), felt[i]) << i;
            ASSERT_EQ(world.sonar(1), heard[i]) << i;
            if (i > 0) recorder.record(world);
            ++i;
        } while (replay.step(world));
        EXPECT_EQ(i, felt.size());
    }
    EXPECT_EQ(readAll(again + "/bumpers.csv"), bumpers);
    EXPECT_EQ(readAll(again + "/sonars.csv"), sonars);
    const auto hit = static_cast<int>(
        std::find_if(felt.begin(), felt.end(),
                     [](const auto& each) { return each != std::vector<bool>(5); }) -
        felt.begin());
    replay.seek(world, (hit + 20) * kStep);
    EXPECT_EQ(world.bumper(0), felt[static_cast<std::size_t>(hit)]) << "after steps passed over";
}

TEST_F(ReplayTest, BeginsWithNobody) {
    writeAll(path("robots.csv"), "t,id,x,y,heading_deg\n0.06,r1,1,0,0\n0.08,r1,1.01,0,0\n");
    writeAll(path("info.csv"), "dt,control_interval,steps\n0.02,0.1,4\n");
    EXPECT_NE(errorOf(folder_.path(), scene_), "");
    writeAll(path("events.csv"),
             "t,kind,id,other,x,y,value,text\n0.06,change,,,,,,ADD robot id=r1\n");
    Replay replay(folder_.path());
    replay.placeAtStart(scene_);
    EXPECT_EQ(scene_.robots[0].pose.position, (Point2{0, 0}));
    World world(scene_, kStep);
    std::string way;
    while (replay.step(world)) way += formatDouble(world.status(0).pose.position.x) + ' ';
    EXPECT_EQ(way, "0 0 1 1.01 ");
}

TEST_F(ReplayTest, PassesOverWhoIsGone) {
    record();
    Replay replay(folder_.path());
    World world(scene_, kStep);
    replay.step(world);
    world.change(scene(kRoom, "robot id=r7 at=-2,-2\nhuman id=h1 at=1,2\n"));
    while (replay.step(world)) continue;
    EXPECT_EQ(world.status(0).pose.position, (Point2{-2, -2}));
    EXPECT_EQ(world.steps(), 200);
}

}  // namespace replay_test
}  // namespace ispace
