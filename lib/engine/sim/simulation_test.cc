// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/simulation.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {
namespace simulation_test {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr nanoseconds kLong = hours(24);  // a budget that no test comes to
constexpr WallTime kStart{hours(1000)};
constexpr Clock kRealTime{Clock::Kind::Real, 1};
constexpr Clock kFast{Clock::Kind::Fast, 1};
constexpr Clock kByStep{Clock::Kind::Step, 1};

/// One robot in a room, in steps of 5 ms unless stated.
class SimulationTest : public ::testing::Test {
  protected:
    SimulationTest() : scene_(testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n")) {
        start(milliseconds(5));
    }
    void start(SimTime step) { world_ = std::make_unique<World>(scene_, step); }
    Simulation simulation(Clock clock, std::optional<SimTime> until = {},
                          const std::string& script = "") {
        return {*world_, readScript(script, "run.txt", *world_), clock, until};
    }
    Scene scene_;
    std::unique_ptr<World> world_;
};

TEST(ParseClock, ReadsAllKinds) {
    EXPECT_EQ(parseClock("real").kind, Clock::Kind::Real);
    EXPECT_EQ(parseClock("real").rate, 1);
    EXPECT_EQ(parseClock("real:20").kind, Clock::Kind::Real);
    EXPECT_EQ(parseClock("real:20").rate, 20);
    EXPECT_EQ(parseClock("real:0.5").rate, 0.5);
    EXPECT_EQ(parseClock("real:1e6").rate, 1e6);
    EXPECT_EQ(parseClock("fast").kind, Clock::Kind::Fast);
    EXPECT_EQ(parseClock("step").kind, Clock::Kind::Step);
}

std::string usage(const std::string& text) {
    try {
        parseClock(text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(ParseClock, SaysWhatIsWanted) {
    EXPECT_EQ(usage("faster"), "unknown clock `faster`, did you mean `fast`?");
    EXPECT_EQ(usage("Real"), "unknown clock `Real`, did you mean `real`?");
    EXPECT_EQ(usage("20"), "unknown clock `20`, wanted real, real:RATE, fast or step");
    EXPECT_EQ(usage("fast:2"), "unknown clock `fast:2`, did you mean `fast`?");
    EXPECT_EQ(usage("real:0"),
              "`0` is no rate of the clock, wanted simulated seconds in a second, above 0 and at "
              "most 1000000, like real:20");
    for (const char* bad : {"", "real:", "real:-1", "real:x", "real:nan", "real:inf", "real:1e7",
                            "real:20x", "real: 1", "real:1e999", "\x1b[2J"})
        EXPECT_NE(usage(bad), "") << bad;
}

TEST_F(SimulationTest, RealTakesTheStepsThatAreDue) {
    Simulation simulation = this->simulation({Clock::Kind::Real, 20});
    EXPECT_EQ(simulation.run(kStart, kLong), kStart + std::chrono::microseconds(250));
    EXPECT_EQ(world_->steps(), 0);
    EXPECT_EQ(simulation.run(kStart + nanoseconds(249'999), kLong),
              kStart + std::chrono::microseconds(250));
    EXPECT_EQ(world_->steps(), 0);
    simulation.run(kStart + std::chrono::microseconds(250), kLong);
    EXPECT_EQ(world_->steps(), 1);
    EXPECT_EQ(simulation.run(kStart + milliseconds(10), kLong),
              kStart + milliseconds(10) + std::chrono::microseconds(250));
    EXPECT_EQ(world_->steps(), 40);
    EXPECT_EQ(simulation.lost(), nanoseconds(0));
    EXPECT_FALSE(simulation.paused());
}

TEST_F(SimulationTest, RealNeitherDriftsNorRunsAhead) {
    std::mt19937_64 random(1);
    for (const std::int64_t rate : {1, 3, 20, 7}) {
        start(milliseconds(7));
        Simulation simulation = this->simulation({Clock::Kind::Real, static_cast<double>(rate)});
        simulation.run(kStart, kLong);
        nanoseconds wall{};
        for (int i = 0; i < 50; ++i) {
            wall += nanoseconds(random() % 5'000'000);
            const auto again = simulation.run(kStart + wall, kLong);
            ASSERT_EQ(world_->steps(), wall.count() * rate / 7'000'000);
            ASSERT_GT(again, kStart + wall);
            // It comes back for the next step, not before and not after.
            const std::int64_t steps = world_->steps();
            simulation.run(*again - nanoseconds(1), kLong);
            ASSERT_EQ(world_->steps(), steps);
            simulation.run(*again, kLong);
            ASSERT_EQ(world_->steps(), steps + 1);
            wall = *again - kStart;
        }
        EXPECT_EQ(simulation.lost(), nanoseconds(0));
    }
}

TEST_F(SimulationTest, ARateChangesFromItsMomentOn) {
    start(milliseconds(10));
    Simulation simulation = this->simulation(kRealTime);
    simulation.run(kStart, kLong);
    simulation.run(kStart + milliseconds(24), kLong);
    EXPECT_EQ(world_->steps(), 2);
    // 4 of the 10 ms of the next step have passed; the rest takes a tenth.
    simulation.setRate(10, kStart + milliseconds(24));
    EXPECT_EQ(simulation.clock().rate, 10);
    EXPECT_EQ(simulation.due(), kStart + milliseconds(24) + std::chrono::microseconds(600));
    simulation.run(kStart + milliseconds(25), kLong);
    EXPECT_EQ(world_->steps(), 3);
    simulation.run(kStart + milliseconds(25) + milliseconds(100), kLong);
    EXPECT_EQ(world_->steps(), 103);

    // In a pause, too.
    const auto then = kStart + milliseconds(126);
    simulation.run(then, kLong);
    const std::int64_t steps = world_->steps();
    const auto ahead = *simulation.due() - then;
    simulation.pause(then);
    simulation.setRate(0.5, then + hours(1));
    simulation.resume(then + hours(2));
    EXPECT_EQ(simulation.due(), then + hours(2) + 20 * ahead);
    EXPECT_EQ(world_->steps(), steps);
}

TEST_F(SimulationTest, AFasterRateMakesNoStepLate) {
    start(milliseconds(10));
    Simulation simulation = this->simulation(kRealTime);
    simulation.run(kStart, kLong);
    // Steps that were due at the old rate stay due, and no more.
    simulation.setRate(1000, kStart + milliseconds(35));
    simulation.run(kStart + milliseconds(35), kLong);
    EXPECT_EQ(world_->steps(), 3);
}

TEST_F(SimulationTest, ASlowClockHasItsNextStepFarAway) {
    Simulation simulation = this->simulation({Clock::Kind::Real, 1e-300});
    const auto again = simulation.run(kStart, kLong);
    ASSERT_TRUE(again);
    EXPECT_GT(*again, kStart + hours(24 * 365 * 90));
    EXPECT_EQ(world_->steps(), 0);
}

TEST_F(SimulationTest, AQuarterOfASecondIsMadeUpFor) {
    Simulation simulation = this->simulation(kRealTime);
    simulation.run(kStart, kLong);
    simulation.run(kStart + milliseconds(255), kLong);  // the first step was due at 5 ms
    EXPECT_EQ(world_->steps(), 51);
    EXPECT_EQ(simulation.lost(), nanoseconds(0));
}

TEST_F(SimulationTest, MoreIsGivenUp) {
    Simulation simulation = this->simulation(kRealTime);
    simulation.run(kStart, kLong);
    const WallTime late = kStart + milliseconds(255) + nanoseconds(1);
    EXPECT_EQ(simulation.run(late, kLong), late + milliseconds(5));
    EXPECT_EQ(world_->steps(), 1);
    EXPECT_EQ(simulation.lost(), milliseconds(250) + nanoseconds(1));
    simulation.run(late + milliseconds(50), kLong);
    EXPECT_EQ(world_->steps(), 11);
    simulation.run(late + hours(1), kLong);
    EXPECT_EQ(world_->steps(), 12);
}

TEST_F(SimulationTest, LongStepsAreNoLag) {
    start(std::chrono::seconds(1));
    Simulation simulation = this->simulation({Clock::Kind::Real, 0.5});
    simulation.run(kStart, kLong);
    EXPECT_EQ(simulation.run(kStart + std::chrono::seconds(2), kLong),
              kStart + std::chrono::seconds(4));
    EXPECT_EQ(world_->steps(), 1);
    EXPECT_EQ(simulation.lost(), nanoseconds(0));
}

TEST_F(SimulationTest, APauseIsNoLag) {
    Simulation simulation = this->simulation(kRealTime);
    simulation.run(kStart, kLong);
    simulation.run(kStart + milliseconds(100), kLong);
    EXPECT_EQ(world_->steps(), 20);
    simulation.pause(kStart + milliseconds(100));
    EXPECT_FALSE(simulation.run(kStart + milliseconds(500), kLong));
    EXPECT_EQ(world_->steps(), 20);
    simulation.allow(3);
    EXPECT_EQ(simulation.owed(), 3);
    EXPECT_FALSE(simulation.run(kStart + milliseconds(900), kLong));
    EXPECT_EQ(world_->steps(), 23);
    EXPECT_EQ(simulation.owed(), 0);
    const WallTime again = kStart + hours(2);
    simulation.resume(again);
    EXPECT_EQ(simulation.run(again, kLong), again + milliseconds(5));
    EXPECT_EQ(world_->steps(), 23);
    simulation.run(again + milliseconds(10), kLong);
    EXPECT_EQ(world_->steps(), 25);
    EXPECT_EQ(simulation.lost(), nanoseconds(0));
}

TEST_F(SimulationTest, PausesCostTheirOwnTimeAlone) {
    Simulation simulation = this->simulation(kRealTime);
    simulation.run(kStart, kLong);
    // Paused every other millisecond: half the time is lost, though no step fits between.
    WallTime now = kStart;
    for (int i = 0; i < 100; ++i) {
        simulation.run(now += milliseconds(1), kLong);
        simulation.pause(now);
        simulation.pause(now += milliseconds(1));
        simulation.resume(now);
    }
    EXPECT_EQ(world_->steps(), 20);
    EXPECT_EQ(simulation.run(now, kLong), now + milliseconds(5));
    // A lag is not lost either.
    simulation.pause(now + milliseconds(100));
    simulation.resume(now + hours(1));
    simulation.run(now + hours(1), kLong);
    EXPECT_EQ(world_->steps(), 40);
    EXPECT_EQ(simulation.lost(), nanoseconds(0));
}

TEST_F(SimulationTest, WhatWasAllowedEndsWithThePause) {
    Simulation simulation = this->simulation(kRealTime);
    simulation.pause(kStart);
    simulation.allow(7);
    simulation.run(kStart, nanoseconds(0));
    EXPECT_EQ(simulation.owed(), 6);
    simulation.resume(kStart);
    EXPECT_EQ(simulation.owed(), 0);
    simulation.pause(kStart);
    simulation.allow(7);
    simulation.pause(kStart);
    EXPECT_EQ(simulation.owed(), 0);
    EXPECT_FALSE(simulation.run(kStart, kLong));
    EXPECT_EQ(world_->steps(), 1);
}

TEST_F(SimulationTest, CallsItsObserversInTheOrderTheyCame) {
    Simulation simulation = this->simulation(kFast, milliseconds(10));
    std::string calls;
    simulation.onStep([&] { calls += 'a'; });
    simulation.onStep([&] { calls += 'b'; });
    simulation.run(kStart, kLong);
    EXPECT_EQ(calls, "abab");
}

TEST_F(SimulationTest, ThePauseOfAnObserverHolds) {
    for (const Clock clock : {kRealTime, kFast}) {
        start(milliseconds(5));
        Simulation simulation = this->simulation(clock);
        simulation.run(kStart, nanoseconds(0));
        simulation.onStep([&] { simulation.pause(kStart); });
        const std::int64_t before = world_->steps();
        EXPECT_FALSE(simulation.run(kStart + milliseconds(100), kLong));
        EXPECT_EQ(world_->steps(), before + 1);
    }
}

TEST_F(SimulationTest, FastGoesOnAtOnceWithinItsBudget) {
    Simulation simulation = this->simulation(kFast);
    EXPECT_EQ(simulation.run(kStart, nanoseconds(0)), kStart);
    EXPECT_EQ(world_->steps(), 1) << "one step at least";
    EXPECT_EQ(simulation.run(kStart, nanoseconds(0)), kStart);
    EXPECT_EQ(world_->steps(), 2);
}

TEST_F(SimulationTest, TheBudgetHoldsForRealToo) {
    Simulation simulation = this->simulation(kRealTime);
    simulation.run(kStart, nanoseconds(0));
    const WallTime now = kStart + milliseconds(100);
    EXPECT_EQ(simulation.run(now, nanoseconds(0)), now) << "more is due at once";
    EXPECT_EQ(world_->steps(), 1);
}

TEST_F(SimulationTest, StepWaitsToBeTold) {
    Simulation simulation = this->simulation(kByStep);
    EXPECT_TRUE(simulation.paused());
    EXPECT_FALSE(simulation.run(kStart, kLong));
    simulation.allow(5);
    EXPECT_EQ(simulation.run(kStart, nanoseconds(0)), kStart);
    EXPECT_EQ(simulation.owed(), 4);
    EXPECT_FALSE(simulation.run(kStart, kLong));
    EXPECT_EQ(world_->steps(), 5);
    EXPECT_EQ(simulation.owed(), 0);
    EXPECT_FALSE(simulation.run(kStart + hours(1), kLong));
    EXPECT_EQ(world_->steps(), 5);
}

TEST_F(SimulationTest, AllTheStepsThereAreMayBeAllowedTwice) {
    Simulation simulation = this->simulation(kByStep, milliseconds(15));
    constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
    simulation.allow(kAll);
    simulation.allow(kAll);
    EXPECT_EQ(simulation.owed(), kAll);
    simulation.run(kStart, kLong);
    EXPECT_EQ(world_->steps(), 3);
}

TEST_F(SimulationTest, EndsAtTheFirstStepAtOrAfterUntil) {
    const std::pair<SimTime, std::int64_t> cases[] = {{milliseconds(15), 3},
                                                      {milliseconds(15) + nanoseconds(1), 4},
                                                      {nanoseconds(1), 1},
                                                      {nanoseconds(0), 0}};
    for (const auto& [until, steps] : cases) {
        start(milliseconds(5));
        Simulation simulation = this->simulation(kFast, until);
        int observed = 0;
        simulation.onStep([&] { ++observed; });
        EXPECT_FALSE(simulation.run(kStart, kLong));
        EXPECT_TRUE(simulation.finished());
        EXPECT_EQ(world_->steps(), steps);
        EXPECT_EQ(observed, steps);
        EXPECT_FALSE(simulation.run(kStart, kLong));
        EXPECT_EQ(world_->steps(), steps);
    }
}

TEST_F(SimulationTest, AnObserverMayFinishIt) {
    Simulation simulation = this->simulation(kFast);
    simulation.onStep([&] {
        if (world_->steps() == 3) simulation.finish();
    });
    EXPECT_FALSE(simulation.run(kStart, kLong));
    EXPECT_EQ(world_->steps(), 3);
}

TEST_F(SimulationTest, GivesScriptedCommandsAtTheFirstStepAtOrAfterTheirTime) {
    Simulation simulation =
        this->simulation(kFast, milliseconds(30), "0 r1 FORWARD 5\n0.007 r1 STOP\n");
    simulation.onStep([&] {
        EXPECT_GT(world_->status(0).pose.position.x, 0) << "the command at 0 acts in step 1";
        // The command is given as soon as step 2 has led to 10 ms.
        const auto ends = world_->ends();
        ASSERT_EQ(ends.size(), world_->steps() == 2 ? 1U : 0U) << world_->steps();
        if (ends.empty()) return;
        EXPECT_EQ(ends[0].id, 1);
        EXPECT_EQ(ends[0].outcome, Outcome::Stopped);
        EXPECT_EQ(ends[0].time, milliseconds(10));
    });
    simulation.run(kStart, kLong);
    EXPECT_EQ(world_->steps(), 6);
}

TEST_F(SimulationTest, TheLastOfSeveralCommandsOfOneTimeHolds) {
    Simulation simulation = this->simulation(
        kFast, milliseconds(20), "0.01 r1 SPEED 0.2\n0.01 r1 ROTSPEED 9\n0.01 r1 STOP\n");
    simulation.run(kStart, kLong);
    EXPECT_EQ(world_->status(0).pose, Pose2{});
}

TEST_F(SimulationTest, CommandsFromTheEndOnAreNotGiven) {
    Simulation simulation =
        this->simulation(kFast, milliseconds(10), "0 r1 FORWARD 5\n0.01 r1 STOP\n0.1 r1 STOP\n");
    simulation.run(kStart, kLong);
    EXPECT_EQ(world_->steps(), 2);
    EXPECT_TRUE(world_->ends().empty());
}

/// What robots.csv holds after a second with this script.
std::string recorded(const Scene& scene, const std::string& script) {
    const testing::TestFolder folder;
    {
        World world(scene, milliseconds(50));
        Recorder recorder(folder.path(), world, {});
        Simulation simulation(world, readScript(script, "run.txt", world), kFast,
                              std::chrono::seconds(1));
        simulation.recordWith(recorder);
        simulation.run(kStart, kLong);
    }
    return readAll(folder / "robots.csv");
}

TEST(SimulationRecord, HoldsEachStepBeforeTheNextCommands) {
    const Scene scene = testing::scene("ispace size=8,6\n", "robot id=r1 at=3.65,0\n");
    const std::string crash = recorded(scene, "0 r1 SPEED 1\n");
    EXPECT_EQ(std::count(crash.begin(), crash.end(), '\n'), 1 + 21);
    const auto mark = crash.find(",1\n");
    ASSERT_NE(mark, std::string::npos) << "no stall in\n" << crash;
    const auto line = crash.rfind('\n', mark) + 1;
    const std::string time = crash.substr(line, crash.find(',', line) - line);
    // Backing out at the very time of the stall takes the flag away, but not from the record.
    const std::string out = recorded(scene, "0 r1 SPEED 1\n" + time + " r1 SPEED -0.1\n");
    EXPECT_EQ(out.substr(0, mark + 3), crash.substr(0, mark + 3));
    EXPECT_EQ(out.find(",1\n", mark + 1), std::string::npos) << out;
}

TEST(SimulationRecord, IsWrittenOutWhileTheWorldRests) {
    const Scene scene = testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n");
    const testing::TestFolder folder;
    World world(scene, milliseconds(50));
    Recorder recorder(folder.path(), world, {});
    Simulation simulation(world, {}, kByStep, {});
    simulation.recordWith(recorder);
    simulation.allow(3);
    auto again = simulation.run(kStart, kLong);
    for (int i = 0; again && i < 10; ++i) {
        std::this_thread::sleep_until(*again);
        again = simulation.run(*again, kLong);
    }
    EXPECT_FALSE(again);  // no work is pending
    EXPECT_NE(readAll(folder / "robots.csv").find("\n0.15,r1,"), std::string::npos);
    EXPECT_EQ(readAll(folder / "info.csv"),
              "dt,control_interval,steps,elapsed,seed,noise\n0.05,0.05,3,0.15,0,0\n");
}

TEST(Simulation, ScriptOfTimeZeroIsGivenBeforeAnyClient) {
    const Scene scene = testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n");
    World world(scene, milliseconds(50));
    Simulation simulation(world, readScript("0 r1 FORWARD 1\n", "run.txt", world), kByStep, {});
    EXPECT_EQ(world.command(0, {Verb::Forward, 2}), 2);
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends()[0].id, 1);
    simulation.allow(1);
    simulation.run(kStart, kLong);
    EXPECT_TRUE(world.ends().empty());
}

TEST(Simulation, EndsAfterAHundredYears) {
    const Scene scene = testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n");
    World world(scene, milliseconds(50));
    EXPECT_FALSE(Simulation(world, {}, kFast, {}).finished());
    EXPECT_TRUE(Simulation(world, {}, kFast, SimTime(0)).finished());
    EXPECT_LT(kMaxTime + World::kMaxStep, SimTime::max());
}

TEST(SimulationRecord, IsTheSameForAnyClock) {
    const Scene scene = testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n");
    const std::string script = "0 r1 SPEED 0.4\n0.3 r1 ROTSPEED 50\n";
    const std::string fast = recorded(scene, script);
    EXPECT_EQ(recorded(scene, script), fast);

    World world(scene, milliseconds(50));
    Simulation simulation(world, readScript(script, "run.txt", world), {}, {});
    for (int i = 0; i <= 100; ++i) simulation.run(kStart + milliseconds(10 * i), kLong);
    World other(scene, milliseconds(50));
    Simulation stepped(other, readScript(script, "run.txt", other), kByStep, {});
    stepped.allow(20);
    stepped.run(kStart, kLong);
    EXPECT_EQ(world.steps(), 20);
    EXPECT_EQ(other.steps(), 20);
    EXPECT_EQ(world.status(0).pose, other.status(0).pose);
    EXPECT_NE(world.status(0).pose, Pose2{});
}

}  // namespace simulation_test
}  // namespace ispace
