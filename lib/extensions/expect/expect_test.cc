// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/expect/expect.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "extensions/expect/expectations.h"
#include "extensions/expect/rule_file.h"
#include "support/test_layout.h"

namespace ispace::expect {
namespace expect_test {

using State = Condition::State;
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
        expectations.reserve(texts.size());
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

/// The condition of a sentence that has one.
Condition only(const std::string& text) {
    const Expectation expectation = parseExpectation(text);
    EXPECT_EQ(expectation.claim.size(), 1U);
    EXPECT_EQ(expectation.claim.front().size(), 1U);
    return expectation.claim.front().front();
}

TEST(ParseExpectation, ReadsAllForms) {
    const Expectation near = parseExpectation("r1 within 40cm of 0.5,-2 after 1min before 90");
    const Condition& place = near.claim.front().front();
    EXPECT_EQ(place.subject, "r1");
    EXPECT_EQ(place.state, State::Near);
    EXPECT_EQ(place.amount, 0.4);
    EXPECT_EQ(place.place, (Point2{0.5, -2}));
    EXPECT_EQ(near.when, When::Once);
    EXPECT_EQ(near.after, seconds(60));
    EXPECT_EQ(near.before, seconds(90));
    EXPECT_EQ(parseExpectation("r1 never within 1 of h1").when, When::Never);
    EXPECT_EQ(only("r1 within 1 of h1 never").name, "h1");
    EXPECT_EQ(only("no collision").subject, "*");
    EXPECT_EQ(only("no stall of r*").subject, "r*");
    EXPECT_EQ(parseExpectation("h1 in zone kitchen for at least 500ms").span, milliseconds(500));
    const Expectation unseen = parseExpectation("h1 unseen at most 2");
    EXPECT_EQ(unseen.claim.front().front().state, State::Seen);
    EXPECT_TRUE(unseen.claim.front().front().is_negated);
    EXPECT_EQ(unseen.when, When::AtMost);
    EXPECT_EQ(only("h1 seen by 3 sensors always").amount, 3);
    EXPECT_FALSE(only("h1 not unseen").is_negated);
    EXPECT_EQ(only("r1 faster than 0.2").state, State::Faster);
}

TEST(ParseExpectation, ReadsThingsEventsAndGates) {
    const Expectation lit = parseExpectation("lamp of kitchen on within 2 s of ann enters kitchen");
    const Condition& lamp = lit.claim.front().front();
    EXPECT_EQ(lamp.subject, "lamp");
    EXPECT_EQ(lamp.part, "kitchen");
    EXPECT_EQ(lamp.key, "on");
    EXPECT_EQ(lit.deadline, seconds(2));
    EXPECT_EQ(lit.event_text, "ann enters kitchen");
    EXPECT_EQ(lit.event.front().front().state, State::InZone);
    EXPECT_EQ(lit.event.front().front().name, "kitchen");
    const Expectation closed =
        parseExpectation("h1 never on while w1 open for more than 60s and d1 not closed after 5");
    EXPECT_EQ(closed.when, When::Never);
    ASSERT_EQ(closed.gate.front().size(), 2U);
    EXPECT_EQ(closed.gate.front()[0].lasts, seconds(60));
    EXPECT_TRUE(closed.gate.front()[1].is_negated);
    EXPECT_TRUE(closed.gate.front()[1].is_opposite);
    EXPECT_EQ(closed.gate_text, "w1 open for more than 60s and d1 not closed");
    EXPECT_EQ(closed.after, seconds(5));
    EXPECT_EQ(parseExpectation("l1 on at most 3 times").times, 3);
    EXPECT_EQ(parseExpectation("l1 on for at most 2h in all").when, When::AtMostInAll);
    EXPECT_EQ(parseExpectation("total heater.kwh below 2.5 at the end").when, When::AtEnd);
    EXPECT_EQ(only("total heater.kwh below 2.5").of, Condition::Of::Total);
    EXPECT_EQ(only("any l* turns off").of, Condition::Of::Any);
    EXPECT_EQ(parseExpectation("l1 on or l2 on and l3 on").claim.size(), 2U);
    EXPECT_EQ(only("c1.motion").state, State::On);
    EXPECT_EQ(only("t1 above -3.5").amount, -3.5);
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
    EXPECT_EQ(only("r1 within 40 cm of 2,1").amount, 0.4);
    EXPECT_EQ(only("r1 faster than 1 m/s never").amount, 1);
    EXPECT_THROW(parseExpectation("r1 still for at least 1 m"), UsageError);
}

TEST(ParseExpectation, SaysWhatIsWanted) {
    EXPECT_EQ(refusal(""), "an expectation is wanted, like `r1 within 0.4 of 2,1 before 60`");
    EXPECT_EQ(refusal("no colision"),
              "`no colision`: wanted `collision` or `stall` after `no`, found `colision`, did you "
              "mean `collision`?");
    EXPECT_EQ(refusal("r1"),
              "`r1`: wanted a state (within, in zone, seen, unseen, stalled, still, faster than, "
              "slower than; on, off, open, closed, above, below, is) after `r1`");
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
    EXPECT_EQ(why("anyone in zone kitchen"), "`anyone in zone kitchen`: no person is in this run");
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

/// A flat whose things a test switches at times, and a person that walks into the kitchen at once:
/// from x = -1 at 0.5 m/s, so that she is in it from t = 3 to 5.
class RuleTest : public ::testing::Test {
  protected:
    static Scene flat(const std::string& lamp, const std::string& window = "",
                      const std::string& heater = "") {
        return testing::scene(
            "ispace id=room size=8,6\nzone id=kitchen at=1,0 size=1,1\n"
            "lamp id=l1 at=1,0 " +
                lamp + "\nlamp id=l2 at=-3,2\nwindow id=w1 at=0,3 " + window +
                "\nheater id=h1 at=-3,0 watts=1800 " + heater + "\n",
            "human id=ann at=-1,0\ngate id=k1 at=3,2\n");
    }

    /// Runs for ten seconds; changes: time and scene.
    std::vector<JudgedExpectation> judged(const std::vector<std::string>& texts,
                                          const std::vector<std::pair<SimTime, Scene>>& changes) {
        World world(start_, milliseconds(100));
        std::vector<Expectation> list;
        list.reserve(texts.size());
        for (const std::string& text : texts) list.push_back(parseExpectation(text));
        judge_.emplace(world, std::move(list));
        world.command(0, {.verb = Verb::Speed, .value = 0.5});
        judge_->observe();
        while (world.time() < seconds(10)) {
            for (const auto& [time, scene] : changes)
                if (time == world.time()) world.change(Scene(scene));
            world.step();
            judge_->observe();
        }
        return judge_->results();
    }
    std::string reason(const std::string& text,
                       const std::vector<std::pair<SimTime, Scene>>& changes = {}) {
        const RunVerdict verdict = judged({text}, changes).front().verdict;
        EXPECT_EQ(verdict.is_met, verdict.reason.empty());
        return verdict.reason;
    }

    Scene start_ = flat("");
    std::optional<ExpectationJudge> judge_;
};

TEST_F(RuleTest, WantsAnswersToEvents) {
    const std::vector<std::pair<SimTime, Scene>> late = {{milliseconds(4500), flat("on=yes")}};
    const std::string rule = "lamp of kitchen on within 1s of ann enters kitchen";
    const JudgedExpectation failed = judged({rule}, late).front();
    EXPECT_FALSE(failed.verdict.is_met);
    EXPECT_EQ(failed.checks, 1);
    EXPECT_EQ(failed.failures, 1);
    ASSERT_EQ(failed.shown.size(), 1U);
    const RunFailure& failure = failed.shown.front();
    EXPECT_EQ(failure.reason.substr(0, 19), "l1 was off at t=4.2");
    EXPECT_EQ(failure.to - failure.from, seconds(1));
    ASSERT_EQ(failure.observed.size(), 3U);
    EXPECT_EQ(failure.observed[0].text, "ann was not in zone kitchen");
    EXPECT_EQ(failure.observed[1].text, "l1 was off");
    EXPECT_EQ(failure.observed[2].text, "ann was in zone kitchen");
    EXPECT_EQ(failure.observed[2].time, failure.from);

    EXPECT_EQ(reason("lamp of kitchen on within 2s of ann enters kitchen", late), "");
    EXPECT_EQ(reason("l1 never on within 1s of ann enters kitchen", late), "");
    EXPECT_NE(reason("l1 never on within 2s of ann enters kitchen", late), "");
    EXPECT_EQ(reason("l1 always off within 1s of ann enters kitchen", late), "");
    EXPECT_EQ(reason("l1 on for at least 5s within 2s of anyone enters kitchen", late), "");
    EXPECT_NE(reason("l1 on for at least 5.6s within 2s of anyone leaves kitchen", late), "");
    EXPECT_EQ(reason("l1 on within 20s of l1 turns off", late),
              "l1: `l1 turns off` never happened; the run ended at t=10.000");
    EXPECT_EQ(reason("l1 off within 9s of l1 turns on", late),
              "l1: the time after `l1 turns on` was cut off; the run ended at t=10.000");
    EXPECT_EQ(reason("l2 on within 1s of ann enters kitchen before 2"),
              "l2: `ann enters kitchen` never happened");
}

TEST_F(RuleTest, JudgesInvariants) {
    const std::vector<std::pair<SimTime, Scene>> open = {
        {seconds(1), flat("", "", "on=yes")},
        {seconds(2), flat("", "open=yes", "on=yes")},
        {seconds(6), flat("", "open=yes", "")},
        {seconds(8), flat("", "", "on=yes")}};
    EXPECT_EQ(reason("h1 never on while w1 open for more than 5s", open), "");
    EXPECT_EQ(reason("h1 never on while w1 open for more than 3s", open),
              "h1 was on at t=5.200 while `w1 open for more than 3s`");
    EXPECT_EQ(reason("w1 open for more than 5s never", open).substr(0, 23),
              "w1 was open at t=7.200");
    const JudgedExpectation off = judged({"h1 always off"}, open).front();
    EXPECT_EQ(off.failures, 2) << "twice on";
    EXPECT_EQ(off.verdict.time, milliseconds(1100));
    EXPECT_EQ(off.shown[0].to, milliseconds(6000));
    EXPECT_EQ(reason("h1 on at most 2 times", open), "");
    EXPECT_EQ(reason("h1 on at most 1 times", open), "h1 was so more than 1 time at t=8.100");
    EXPECT_EQ(reason("h1 on at least 3 times", open),
              "h1 was so 2 times; the run ended at t=10.000");
    EXPECT_EQ(reason("h1 on for at most 6.9s in all", open), "");
    EXPECT_NE(reason("h1 on for at most 6.8s in all", open), "");
    EXPECT_NE(reason("h1 on for at least 7s in all", open), "");
    EXPECT_EQ(reason("h1 on at the end", open), "");
    EXPECT_EQ(reason("h1 off at the end", open), "h1 was on at the end; the run ended at t=10.000");
}

TEST_F(RuleTest, MeasuresEnergyZonesAndValues) {
    const std::vector<std::pair<SimTime, Scene>> heats = {
        {seconds(2), flat("on=yes level=30%", "", "on=yes level=50%")}, {seconds(6), flat("")}};
    // 900 W for four seconds: a Wh.
    EXPECT_EQ(reason("h1.kwh below 0.00101 always", heats), "");
    EXPECT_EQ(reason("h1.kwh above 0.00099 at the end", heats), "");
    EXPECT_EQ(reason("total heater.watts above 800 for at least 3.9s", heats), "");
    EXPECT_EQ(reason("total heater.kwh below 0.0005 always", heats).substr(0, 34),
              "total heater.kwh had kwh 0.0005 at");
    EXPECT_EQ(reason("l1.level is 0.3 before 3", heats), "");
    EXPECT_EQ(reason("kitchen occupied for at least 1.9s"), "");
    EXPECT_EQ(reason("kitchen.people above 0 at least 2 times"),
              "kitchen was so 1 time; the run ended at t=10.000");
    EXPECT_EQ(reason("any lamp on", heats), "");
    EXPECT_EQ(reason("lamp on", heats), "l2 was never so; the run ended at t=10.000");
    EXPECT_EQ(reason("l1 on and kitchen occupied", heats), "");
    EXPECT_NE(reason("l1 on and kitchen occupied after 6.1", heats), "");
    EXPECT_EQ(reason("l2 on or kitchen occupied always after 3.3 before 4", heats), "");
}

TEST_F(RuleTest, NamesWhatIsNotThere) {
    World world(start_, milliseconds(100));
    const auto why = [&](const std::string& text) -> std::string {
        try {
            ExpectationJudge(world, {parseExpectation(text)});
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(why("lammp on"), "`lammp on`: no thing is `lammp`, did you mean `lamp`?");
    EXPECT_EQ(why("l1.levle above 0.5"),
              "`l1.levle above 0.5`: l1 has no state `levle`, did you mean `level`?");
    EXPECT_EQ(why("l1 above 0.5"),
              "`l1 above 0.5`: l1 has the states color, level, on: give one, such as l1.color");
    EXPECT_EQ(why("lamp of kichen on").substr(0, 20), "`lamp of kichen on`:");
    EXPECT_NE(why("lamp of kichen on").find("did you mean `kitchen`?"), std::string::npos);
    EXPECT_NE(why("window of kitchen open"), "");
    EXPECT_NE(why("l1 on within 1s of bob enters kitchen").find("no robot or person is `bob`"),
              std::string::npos);
    EXPECT_NE(why("total l1.color above 1").find("is no number"), std::string::npos);
    EXPECT_EQ(why("k1 broken"), "");
    EXPECT_EQ(why("l1.on on"), "");
    EXPECT_NE(why("l1.level on"), "");
}

TEST(RuleFile, ReadsSentencesWithTheirPlaces) {
    const auto rules = readRules(
        "rules:\n  - no collision\n  - name: light\n    expect: 'l1 on within 2s of ann enters "
        "k'\n",
        "rules.yaml");
    ASSERT_EQ(rules.size(), 2U);
    EXPECT_EQ(rules[0].source.line, 2);
    EXPECT_EQ(rules[0].source.column, 5);
    EXPECT_EQ(rules[1].name, "light");
    EXPECT_EQ(rules[1].source.column, 14) << "after the quote";
    EXPECT_EQ(readRules("- r1 still\n", "a.yaml").size(), 1U);
    for (const char* const none : {"", "# later\n", "rules: []\n", "[]"})
        EXPECT_THROW(static_cast<void>(readRules(none, "a.yaml")), FormatError) << none;
}

TEST(RuleFile, TellsAllErrorsWithLineAndColumn) {
    try {
        readRules(
            "rules:\n  - no colision\n  - nam: x\n    expect: r1 still\n  - name: y\n  - l1 onn\n",
            "rules.yaml");
        FAIL();
    } catch (const FormatError& error) {
        std::vector<std::string> texts;
        for (const Diagnostic& finding : error.diagnostics()) texts.push_back(finding.text());
        ASSERT_EQ(texts.size(), 4U);
        EXPECT_EQ(texts[0],
                  "rules.yaml:2:8: error: `no colision`: wanted `collision` or `stall` after `no`, "
                  "found `colision`, did you mean `collision`?");
        EXPECT_EQ(texts[1], "rules.yaml:3:5: error: unknown key `nam`, did you mean `name`?");
        EXPECT_EQ(texts[2],
                  "rules.yaml:5:5: error: wanted a sentence, or a map with `expect` and `name`");
        EXPECT_EQ(texts[3].substr(0, 22), "rules.yaml:6:8: error:");
    }
    for (const char* const text : {"rules: 3\n", "3\n", "rule:\n  - a\n", "- [a]\n",
                                   "rules: [r1 still]\nrules: [r1 still]\n"})
        EXPECT_THROW(readRules(text, "a.yaml"), FormatError) << text;
}

TEST_F(RuleTest, ReportsWithTheCommandOfAFilm) {
    const std::string rule = "l1 on within 1s of ann enters kitchen";
    const auto results = judged({rule, "l1 off always"}, {});
    const std::string text = expectationsText(results, "run");
    EXPECT_NE(text.find("FAILED  " + rule), std::string::npos);
    EXPECT_NE(text.find("met     l1 off always"), std::string::npos);
    EXPECT_NE(text.find("simrun --replay run --from "), std::string::npos);
    EXPECT_EQ(expectationsText(results, "").find("simrun"), std::string::npos);
    EXPECT_NE(
        expectationsJson(results, "run").find("\"met\":false,\"rules\":[{\"expect\":\"" + rule),
        std::string::npos);
}

/// Sentences of random words are parsed and judged, or refused with the place of a word.
TEST(ParseExpectation, TakesRandomWords) {
    const std::vector<std::string> words = {"r1",     "ann",      "l1",
                                            "k1",     "kitchen",  "lamp",
                                            "*",      "any",      "total",
                                            "not",    "always",   "never",
                                            "within", "in",       "zone",
                                            "of",     "1",        "2s",
                                            "0.5,1",  "on",       "off",
                                            "open",   "above",    "is",
                                            "seen",   "by",       "enters",
                                            "leaves", "for",      "at",
                                            "least",  "most",     "more",
                                            "than",   "times",    "all",
                                            "the",    "end",      "and",
                                            "or",     "while",    "after",
                                            "before", "no",       "collision",
                                            "still",  "faster",   "turns",
                                            "anyone", "l1.level", "kitchen.people",
                                            "h1.kwh"};
    const Scene scene =
        testing::scene(kRoom + std::string("lamp id=l1 at=1,0\nheater id=h1 at=0,1\n"
                                           "window id=w1 at=0,3\n"),
                       "robot id=r1 at=0,0\nhuman id=ann at=-1,0\n"
                       "gate id=k1 at=1,2\n");
    World world(scene, kStep);
    std::mt19937 random(3);
    std::size_t parsed = 0, judged = 0;
    for (int round = 0; round < 100'000; ++round) {
        std::string text;
        for (std::size_t i = 0, count = 1 + random() % 9; i < count; ++i)
            text.append(i == 0 ? "" : " ").append(words[random() % words.size()]);
        try {
            Expectation sentence = parseExpectation(text);
            ++parsed;
            if (parsed % 10 != 0) continue;
            ExpectationJudge judge(world, {std::move(sentence)});
            judge.observe();
            const RunVerdict verdict = judge.verdicts().front();
            EXPECT_EQ(verdict.is_met, verdict.reason.empty()) << text;
            ++judged;
        } catch (const SentenceError& error) {
            EXPECT_LE(error.offset(), text.size()) << text;
        } catch (const UsageError&) {  // a name that the world lacks
        }
    }
    EXPECT_GT(parsed, 250U);
    EXPECT_GT(judged, 10U);
}

}  // namespace expect_test
}  // namespace ispace::expect
