// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/expect.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/test_layout.h"

namespace ispace {
namespace {

using State = Expectation::State;
using When = Expectation::When;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr SimTime kStep = milliseconds(10);
constexpr const char* kRoom =
    "ispace id=room size=8,6\nzone id=kitchen at=1,0 size=1,1\npillar id=post at=3,0 "
    "size=0.2,0.2,2.5\n";

/// r1 goes ahead at 0.5 m/s at once, and r2 stands; a laser sees from (1.5, 1) to all sides.
class ExpectTest : public ::testing::Test {
  protected:
    ExpectTest()
        : scene_(testing::scene(kRoom,
                                "robot id=r1 at=0,0 accel=1000 speed=0.5\nrobot id=r2 at=0,-2\n"
                                "laser at=1.5,1 range=1.2 fov=360\n")),
          world_(scene_, kStep) {}

    std::vector<RunVerdict> judged(const std::vector<std::string>& texts, SimTime end,
                                   double distance = 2) {
        std::vector<Expectation> expectations;
        for (const std::string& text : texts) expectations.push_back(parseExpectation(text));
        ExpectationJudge judge(world_, std::move(expectations));
        world_.command(0, {.verb = Verb::Forward, .value = distance});
        judge.observe();
        while (world_.time() < end) {
            world_.step();
            judge.observe();
        }
        return judge.verdicts();
    }
    /// Why one is not met; "" if it is.
    std::string reason(const std::string& text, SimTime end = seconds(6)) {
        world_ = World(scene_, kStep);
        const RunVerdict verdict = judged({text}, end).front();
        EXPECT_EQ(verdict.is_met, verdict.reason.empty());
        return verdict.reason;
    }

    Scene scene_;
    World world_;
};

TEST(ParseExpectation, ReadsAllForms) {
    const Expectation near = parseExpectation("r1 within 40cm of 0.5,-2 after 1min before 90");
    EXPECT_EQ(near.subject, "r1");
    EXPECT_EQ(near.state, State::Near);
    EXPECT_EQ(near.amount, 0.4);
    EXPECT_EQ(near.place, (Point2{0.5, -2}));
    EXPECT_EQ(near.when, When::Once);
    EXPECT_EQ(near.after, seconds(60));
    EXPECT_EQ(near.before, seconds(90));
    EXPECT_EQ(parseExpectation("r1 never within 1 of h1").when, When::Never);
    EXPECT_EQ(parseExpectation("r1 within 1 of h1 never").name, "h1");
    EXPECT_EQ(parseExpectation("no collision").subject, "*");
    EXPECT_EQ(parseExpectation("no stall of r*").subject, "r*");
    EXPECT_EQ(parseExpectation("h1 in zone kitchen for at least 500ms").span, milliseconds(500));
    const Expectation unseen = parseExpectation("h1 unseen at most 2");
    EXPECT_EQ(unseen.state, State::Seen);
    EXPECT_TRUE(unseen.is_negated);
    EXPECT_EQ(unseen.when, When::AtMost);
    EXPECT_EQ(parseExpectation("h1 seen by 3 sensors always").amount, 3);
    EXPECT_FALSE(parseExpectation("h1 not unseen").is_negated);
    EXPECT_EQ(parseExpectation("r1 faster than 0.2").state, State::Faster);
}

std::string refusal(const std::string& text) {
    try {
        parseExpectation(text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(ParseExpectation, TakesABlankBeforeAUnit) {
    const Expectation unseen = parseExpectation("h1 unseen for at most 1 s before 2 min");
    EXPECT_EQ(unseen.when, When::AtMost);
    EXPECT_EQ(unseen.span, seconds(1));
    EXPECT_EQ(unseen.before, seconds(120));
    EXPECT_EQ(parseExpectation("r1 within 40 cm of 2,1").amount, 0.4);
    EXPECT_EQ(parseExpectation("r1 faster than 1 m/s never").amount, 1);
    EXPECT_THROW(parseExpectation("r1 still for at least 1 m"), UsageError);
}

TEST(ParseExpectation, SaysWhatIsWanted) {
    EXPECT_EQ(refusal(""), "an expectation is wanted, like `r1 within 0.4 of 2,1 before 60`");
    EXPECT_EQ(refusal("no colision"),
              "`no colision`: wanted `collision` or `stall` after `no`, found `colision`, did you "
              "mean `collision`?");
    EXPECT_EQ(refusal("r1"),
              "`r1`: wanted a state (within, in zone, seen, unseen, stalled, still, faster than, "
              "slower than) after `r1`");
    EXPECT_EQ(refusal("r1 within -1 of 0,0"),
              "`r1 within -1 of 0,0`: wanted a distance in metres after `within`, found `-1`");
    EXPECT_EQ(refusal("r1 within 1 of 0,0,0"),
              "`r1 within 1 of 0,0,0`: wanted a place X,Y or an id after `of`, found `0,0,0`");
    EXPECT_NE(refusal("r1 in zone a untill 5").find("found `untill`"), std::string::npos);
    EXPECT_NE(refusal("r1 within 1 of h1 befor 5").find("did you mean `before`?"),
              std::string::npos);
    EXPECT_NE(refusal("r1 still before 1d").find("in seconds or with a unit"), std::string::npos);
    EXPECT_NE(refusal("r1 still before 2 after 5").find("ends before it begins"),
              std::string::npos);
    EXPECT_NE(refusal("r1 seen by 0"), "");
    EXPECT_NE(refusal("r1 still always never"), "");
    EXPECT_NE(refusal("r1 still before 1 before 2"), "");
    EXPECT_NE(refusal("r1 still for 5"), "");
}

TEST_F(ExpectTest, RefusesWhatIsNotThere) {
    const auto why = [this](const std::string& text) -> std::string {
        try {
            ExpectationJudge(world_, {parseExpectation(text)});
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(why("r3 still"), "`r3 still`: no robot or person is `r3`, did you mean `r1`?");
    EXPECT_EQ(why("r1 within 1 of x9"), "`r1 within 1 of x9`: no robot or person is `x9`");
    EXPECT_NE(why("r1 in zone kichen").find("did you mean `kitchen`?"), std::string::npos);
    EXPECT_EQ(why("r1 in zone rect:0,0,1,1"), "");
    EXPECT_EQ(why("r* still"), "");
    EXPECT_NE(why("x* still"), "");
}

TEST_F(ExpectTest, ReachesPlaces) {
    EXPECT_EQ(reason("r1 within 0.1 of 2,0 before 4"), "");
    EXPECT_EQ(reason("r1 within 0.1 of 2,0 before 3"), "r1 came no nearer than 0.5001 m (t=3.000)");
    EXPECT_EQ(reason("r1 within 0.1 of 2,1"),
              "r1 came no nearer than 1 m (t=4.010); the run ended at t=6.000");
    EXPECT_EQ(reason("r1 within 0.1 of 2,0 before 9", seconds(2)),
              "r1 came no nearer than 1 m (t=2.000); the run ended at t=2.000");
    EXPECT_EQ(reason("r1 within 2 of r2 never"), "r1 was 2 m away at t=0.000");
    EXPECT_EQ(reason("r1 within 1.9 of r2 never"), "");
    EXPECT_EQ(reason("r1 not within 2.1 of r2 before 2"), "");
}

TEST_F(ExpectTest, KnowsZonesAndDurations) {
    // In the zone from x = 0.5 to x = 1.5: two seconds.
    EXPECT_EQ(reason("r1 in zone kitchen before 1.1"), "");
    EXPECT_EQ(reason("r1 in zone kitchen before 0.9"), "r1 was never so");
    EXPECT_EQ(reason("r1 in zone kitchen for at least 1.9"), "");
    EXPECT_NE(reason("r1 in zone kitchen for at least 2.1"), "");
    EXPECT_EQ(reason("r1 in zone kitchen at most 2.1"), "");
    EXPECT_EQ(reason("r1 in zone kitchen at most 1"), "r1 was so for more than 1 s from t=1.010");
    EXPECT_EQ(reason("r1 never in zone kitchen before 0.9"), "");
    EXPECT_EQ(reason("r1 never in zone kitchen"), "r1 was in zone kitchen at t=1.010");
    EXPECT_EQ(reason("r1 always in zone kitchen after 2 before 2.5"), "");
    EXPECT_EQ(reason("r1 always in zone kitchen after 2"), "r1 was not in zone kitchen at t=3.010");
}

TEST_F(ExpectTest, KnowsWhoIsSeen) {
    // Within 1.2 m of (1.5, 1): from x = 0.8367 to the end.
    EXPECT_EQ(reason("r1 seen before 1.7"), "");
    EXPECT_EQ(reason("r1 seen before 1.6"), "r1 was never so");
    EXPECT_EQ(reason("r1 unseen at most 1.7"), "");
    EXPECT_NE(reason("r1 unseen at most 1.6"), "");
    EXPECT_EQ(reason("r1 seen by 2"), "r1 was never so; the run ended at t=6.000");
    EXPECT_EQ(reason("r2 never seen"), "");
    EXPECT_EQ(reason("r1 always seen after 1 before 3"), "r1 was seen by 0 sensors at t=1.000");
}

TEST_F(ExpectTest, KnowsSpeeds) {
    EXPECT_EQ(reason("r1 faster than 0.4 before 1"), "");
    EXPECT_EQ(reason("r1 always slower than 0.4"), "r1 went at 0.5 m/s at t=0.010");
    EXPECT_EQ(reason("r1 still after 4.1"), "");
    EXPECT_EQ(reason("r2 always still"), "");
    EXPECT_EQ(reason("r* always still after 1").substr(0, 10), "r1 went at");
}

TEST_F(ExpectTest, KnowsCollisions) {
    const auto verdicts = judged({"no collision", "no collision of r2", "no stall of r1 before 2",
                                  "r1 stalled before 8", "no collision of r1"},
                                 seconds(8), 5);
    EXPECT_FALSE(verdicts[0].is_met);
    EXPECT_EQ(verdicts[0].reason.substr(0, 23), "r1 ran into post at t=5");
    EXPECT_TRUE(verdicts[1].is_met);
    EXPECT_TRUE(verdicts[2].is_met);
    EXPECT_EQ(verdicts[2].time, seconds(2));
    EXPECT_TRUE(verdicts[3].is_met);
    EXPECT_EQ(verdicts[4].reason, verdicts[0].reason);
    EXPECT_EQ(unmetText({verdicts[0], verdicts[1]}),
              "expected `no collision`: " + verdicts[0].reason);
}

TEST(ExpectPeople, AreSubjectsAsRobotsAre) {
    const Scene scene = testing::scene(kRoom,
                                       "robot id=r1 at=0,0\nhuman id=h1 at=1.5,0 heading=90\n"
                                       "camera on=h1 at=0,0,1.6 tilt=-40 fov=60\n"
                                       "laser at=1.5,1 range=1.2 fov=360\n");
    World world(scene, kStep);
    ExpectationJudge judge(
        world, {parseExpectation("h1 seen by 1 always"), parseExpectation("h1 seen by 2"),
                parseExpectation("r1 within 0.9 of h1"), parseExpectation("no collision of h1")});
    world.command(0, {.verb = Verb::Forward, .value = 1.4});
    for (judge.observe(); world.time() < seconds(6); judge.observe()) world.step();
    const auto verdicts = judge.verdicts();
    EXPECT_TRUE(verdicts[0].is_met);
    EXPECT_FALSE(verdicts[1].is_met) << "her own camera does not count";
    EXPECT_TRUE(verdicts[2].is_met);
    EXPECT_EQ(verdicts[3].reason.substr(0, 22), "h1 was run into by r1 ");
}

TEST_F(ExpectTest, WhatWasNotLookedAtIsNotMet) {
    EXPECT_EQ(reason("r1 never stalled after 9"),
              "r1 was not there in time; the run ended at t=6.000");
    EXPECT_NE(reason("r1 always still after 9"), "");
}

TEST_F(ExpectTest, OutlivesChangesOfTheWorld) {
    ExpectationJudge judge(
        world_, {parseExpectation("r2 always still"), parseExpectation("r1 seen before 5")});
    judge.observe();
    world_.change(testing::scene(kRoom, "robot id=r2 at=0,-2\n"));
    world_.step();
    judge.observe();
    const auto verdicts = judge.verdicts();
    EXPECT_TRUE(verdicts[0].is_met);
    EXPECT_FALSE(verdicts[1].is_met);
}

}  // namespace
}  // namespace ispace
