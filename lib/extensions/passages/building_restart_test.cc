// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "extensions/passages/building_run.h"
#include "extensions/passages/passages_test.h"

namespace ispace::passages {
namespace building_restart_test {

using testing::await;
using testing::buildingOf;
using testing::optionsOf;
using testing::poseOf;
using testing::step;

void runUntil(BuildingRun& run, double time) {
    while (seconds(run.world(0).time()) < time) step(run);
}

/// Returns how the command of a mover ended, if it did.
std::optional<Outcome> endOf(const BuildingRun& run, const std::string& mover, int id) {
    for (const TripEnd& end : run.tripEnds())
        if (end.mover == mover && end.id == id) return end.outcome;
    return std::nullopt;
}

TEST(BuildingPlace, PutsARobotOnItsStoreyAndOnAnother) {
    const SiteScene building =
        buildingOf("robot id=ground/r1 at=6,4\nlaser id=ground/eye on=ground/r1 at=0,0,0.3\n");
    BuildingRun run(building, optionsOf());
    std::vector<std::pair<std::size_t, std::size_t>> moves;
    run.onMove([&](const std::string& /*mover*/, std::size_t from, std::size_t to) {
        moves.emplace_back(from, to);
    });
    EXPECT_EQ(run.place("ground/r1", RoomPoint{0, {8, 5}}, std::nullopt), "");
    EXPECT_EQ(poseOf(run, "ground/r1").position, (Point2{8, 5}));
    EXPECT_EQ(run.place("ground/r1", std::nullopt, Angle::degrees(90)), "");
    EXPECT_EQ(poseOf(run, "ground/r1").position, (Point2{8, 5}));
    EXPECT_NEAR(poseOf(run, "ground/r1").heading.degrees(), 90, 1e-9);
    EXPECT_TRUE(moves.empty());
    EXPECT_EQ(run.place("ground/r1", RoomPoint{1, {9, 6}}, std::nullopt), "");
    EXPECT_EQ(run.roomOf("ground/r1"), 1U);
    EXPECT_EQ(poseOf(run, "ground/r1").position, (Point2{9, 6}));
    EXPECT_NEAR(poseOf(run, "ground/r1").heading.degrees(), 90, 1e-9);
    EXPECT_EQ(moves, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}}));
    EXPECT_TRUE(run.world(1).sensorNamed("ground/eye"));
    // It goes on from there.
    ASSERT_EQ(run.travel("ground/r1", {{{0, {9, 6}}}}).refusal, "");
    const auto end = await(run, "ground/r1", 120);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->outcome, Outcome::Done);
    EXPECT_EQ(run.roomOf("ground/r1"), 0U);
}

TEST(BuildingPlace, EndsTripsAndCommandsAsStopped) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    const TripAnswer trip = run.travel("ground/r1", {{{1, {9, 6}}}});
    runUntil(run, 1);
    EXPECT_EQ(run.place("ground/r1", RoomPoint{1, {6, 4}}, std::nullopt), "");
    EXPECT_EQ(endOf(run, "ground/r1", trip.id), Outcome::Stopped);
    runUntil(run, 3);
    EXPECT_EQ(poseOf(run, "ground/r1").position, (Point2{6, 4})) << "it stands";
    World& upper = run.rooms()[1].simulation->world();
    const int forward = upper.command(upper.moverNamed("ground/r1").value(), {Verb::Forward, 2});
    EXPECT_GT(forward, trip.id);
    runUntil(run, 4);
    EXPECT_EQ(run.place("ground/r1", RoomPoint{0, {6, 4}}, std::nullopt), "");
    EXPECT_EQ(endOf(run, "ground/r1", forward), Outcome::Stopped);
    runUntil(run, 5);
    EXPECT_EQ(poseOf(run, "ground/r1").position, (Point2{6, 4}));
}

TEST(BuildingPlace, RefusesOccupiedFloorLiftsAndStairs) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\nhuman id=upper/h at=9,6\n");
    BuildingRun run(building, optionsOf());
    EXPECT_EQ(run.place("ground/r1", RoomPoint{1, {9, 6.1}}, std::nullopt),
              "ground/r1 has no room at upper/9,6.1: upper/h stands there");
    EXPECT_EQ(run.place("ground/r1", RoomPoint{0, {0, 4}}, std::nullopt),
              "ground/r1 has no room at ground/0,4: ground/f stands there");
    EXPECT_EQ(run.place("ground/r1", RoomPoint{2, {1, 4}}, std::nullopt), "l1 is no storey");
    EXPECT_EQ(poseOf(run, "ground/r1").position, (Point2{6, 4}));
    ASSERT_EQ(run.travel("ground/r1", {{{1, {6, 4}}}}).refusal, "");
    while (run.roomOf("ground/r1") != 2U) step(run);
    EXPECT_EQ(run.place("ground/r1", RoomPoint{0, {6, 4}}, std::nullopt),
              "ground/r1 is in l1: it first goes on to a storey");
    EXPECT_TRUE(await(run, "ground/r1", 120)) << "its trip goes on";
    EXPECT_EQ(run.roomOf("ground/r1"), 1U);
}

TEST(BuildingPlace, RefusesValuesOutOfRange) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    for (const std::size_t storey : {0U, 1U}) {
        EXPECT_NE(run.place("ground/r1", RoomPoint{storey, {2e6, 4}}, std::nullopt)
                      .find("2000000 is above 1000000"),
                  std::string::npos);
        EXPECT_EQ(run.roomOf("ground/r1"), 0U);
        EXPECT_EQ(poseOf(run, "ground/r1").position, (Point2{6, 4}));
    }
    EXPECT_EQ(run.place("ground/r1", RoomPoint{1, {6, 4}}, std::nullopt), "") << "as before";
}

TEST(BuildingPlace, LeavesAllAsItIsIfRefused) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    for (const std::size_t storey : {0U, 1U}) {
        World& world = run.rooms()[storey].simulation->world();
        std::vector<Record> records = world.scene().records;
        for (const Record& record :
             testing::layoutDocument("cube id=box at=8,2 size=1,1,1\n").records)
            records.push_back(record);
        world.change(makeScene(std::move(records), world.scene(), building.devices));
    }
    const TripAnswer trip = run.travel("ground/r1", {{{1, {9, 6}}}});
    runUntil(run, 1);
    const Pose2 before = poseOf(run, "ground/r1");
    EXPECT_EQ(run.place("ground/r1", RoomPoint{0, {8, 2}}, std::nullopt),
              "ground/r1 has no room at ground/8,2: ground/box stands there");
    EXPECT_EQ(run.place("ground/r1", RoomPoint{1, {8, 2}}, std::nullopt),
              "ground/r1 has no room at upper/8,2: upper/box stands there");
    EXPECT_EQ(poseOf(run, "ground/r1"), before);
    EXPECT_EQ(endOf(run, "ground/r1", trip.id), std::nullopt);
    EXPECT_EQ(run.place("ground/r1", RoomPoint{0, {6, 4}}, std::nullopt), "");
    EXPECT_EQ(endOf(run, "ground/r1", trip.id), Outcome::Stopped);
}

/// Poses of all movers, and the lifts.
std::string stateText(const BuildingRun& run) {
    std::string text;
    for (const RunRoom& room : run.rooms()) {
        const World& world = room.simulation->world();
        text += room.id + ':';
        for (std::size_t i = 0; i < world.movers().size(); ++i) {
            const Pose2 pose = world.status(i).pose;
            text += ' ' + world.movers()[i].id + ' ' + std::to_string(pose.position.x) + ' ' +
                    std::to_string(pose.position.y) + ' ' + std::to_string(pose.heading.degrees());
        }
        text += '\n';
    }
    for (const LiftState& lift : run.lifts()) {
        text += lift.id + ' ' + lift.storey + ' ' + std::to_string(lift.height) + ' ' +
                std::to_string(lift.door);
        for (const std::string& rider : lift.riders) text += ' ' + rider;
        for (const std::string& call : lift.calls) text += ' ' + call;
        text += '\n';
    }
    return text;
}

TEST(BuildingRestart, RepeatsTheRunFromItsStart) {
    const std::string layout =
        "robot id=ground/r1 at=6,4 trip=\"upper/9,6;ground/6,4\" loop=yes\n"
        "robot id=upper/r2 at=6,4\n"
        "human id=upper/h at=9,3 trip=\"ground/9,6\"\n";
    // At any moment: walking, waiting, in the lift, on stairs, leaving.
    for (const double moment : {0.5, 7.0, 13.0, 17.0, 24.0, 40.0}) {
        const SiteScene building = buildingOf(layout);
        BuildingRun run(building, optionsOf());
        ASSERT_EQ(run.travel("upper/r2", {{{0, {9, 6}}}}).refusal, "");
        runUntil(run, moment);
        run.restart();
        const SiteScene again = buildingOf(layout);
        BuildingRun fresh(again, optionsOf());
        EXPECT_EQ(stateText(run), stateText(fresh)) << moment;
        for (int i = 0; i < 3000; ++i) {
            step(run);
            step(fresh);
        }
        EXPECT_EQ(stateText(run), stateText(fresh)) << moment;
    }
}

TEST(BuildingRestart, EndsCommandsAndCountsOn) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    ASSERT_EQ(run.travel("ground/r1", {{{1, {9, 6}}}}).refusal, "");
    ASSERT_TRUE(await(run, "ground/r1", 120));
    const TripAnswer back = run.travel("ground/r1", {{{0, {6, 4}}}});
    step(run);
    const SimTime time = run.world(0).time();
    std::vector<std::size_t> to;
    run.onMove([&](const std::string& /*mover*/, std::size_t /*from*/, std::size_t room) {
        to.push_back(room);
    });
    run.restart();
    EXPECT_EQ(endOf(run, "ground/r1", back.id), Outcome::Stopped);
    EXPECT_EQ(to, (std::vector<std::size_t>{0}));
    EXPECT_EQ(run.roomOf("ground/r1"), 0U);
    EXPECT_EQ(run.world(0).time(), time) << "time goes on";
    EXPECT_GT(run.travel("ground/r1", {{{1, {9, 6}}}}).id, back.id);
}

}  // namespace building_restart_test
}  // namespace ispace::passages
