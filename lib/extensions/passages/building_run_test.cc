// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/passages/building_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "extensions/passages/cabin.h"
#include "extensions/passages/passages_test.h"

namespace ispace::passages {
namespace building_run_test {

using testing::await;
using testing::buildingOf;
using testing::kBuilding;
using testing::optionsOf;
using testing::poseOf;
using testing::step;

TEST(BuildingRun, HasAWorldForEachStoreyCabinAndFlight) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    const BuildingRun run(building, optionsOf());
    std::vector<std::string> ids;
    for (const RunRoom& room : run.rooms()) ids.push_back(room.id);
    EXPECT_EQ(ids, (std::vector<std::string>{"ground", "upper", "l1", "s1"}));
    EXPECT_EQ(run.roomOf("ground/r1"), 0U);
    EXPECT_EQ(run.roomOf("r1"), std::nullopt);
    EXPECT_EQ(run.whereText(1), "storey=upper");
    EXPECT_EQ(run.whereText(2), "storey=ground in=l1 z=0.000");
}

TEST(BuildingRun, ARobotTakesTheLift) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    const TripAnswer answer = run.travel("ground/r1", {{{1, {9, 6}}}});
    ASSERT_EQ(answer.refusal, "");
    EXPECT_EQ(answer.via, "l1");
    EXPECT_EQ(answer.id, 1);
    std::vector<std::size_t> rooms = {0};
    const auto end = await(run, "ground/r1", 120, [&] {
        if (const auto room = run.roomOf("ground/r1"); room != rooms.back()) rooms.push_back(*room);
    });
    ASSERT_TRUE(end);
    EXPECT_EQ(end->outcome, Outcome::Done);
    EXPECT_EQ(end->id, 1);
    EXPECT_EQ(rooms, (std::vector<std::size_t>{0, 2, 1}));
    EXPECT_NEAR(distance(poseOf(run, "ground/r1").position, Point2{9, 6}), 0, 0.02);
}

TEST(BuildingRun, ATripTellsItsWaysOnOtherStoreys) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    EXPECT_TRUE(run.plannedPaths(1).empty());
    ASSERT_EQ(run.travel("ground/r1", {{{1, {9, 6}}}}).refusal, "");
    step(run);
    EXPECT_TRUE(run.plannedPaths(0).empty());
    EXPECT_TRUE(run.plannedPaths(2).empty());
    std::vector<PlannedPath> ways = run.plannedPaths(1);
    ASSERT_EQ(ways.size(), 1U);
    EXPECT_EQ(ways[0].mover, "ground/r1");
    ASSERT_GE(ways[0].points.size(), 2U);
    EXPECT_EQ(ways[0].points.back(), (Point2{9, 6}));
    const auto index = run.world(0).moverNamed("ground/r1").value();
    EXPECT_FALSE(run.world(0).wayAhead(index).empty()) << "the way to the lift";
    bool was_upstairs = false;
    const auto end = await(run, "ground/r1", 120, [&] {
        if (run.roomOf("ground/r1") != 1U) return;
        ways = run.plannedPaths(1);
        was_upstairs |=
            !run.world(1).wayAhead(run.world(1).moverNamed("ground/r1").value()).empty();
    });
    ASSERT_TRUE(end);
    EXPECT_TRUE(ways.empty()) << "on its last storey";
    EXPECT_TRUE(was_upstairs);
    EXPECT_TRUE(run.plannedPaths(1).empty());
}

TEST(BuildingRun, ATripEndsWithAHeading) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    TripPlan plan{.points = {{1, {9, 6}}}};
    plan.heading = Angle::degrees(-120);
    const TripAnswer answer = run.travel("ground/r1", plan);
    const auto end = await(run, "ground/r1", 120, [] {});
    ASSERT_TRUE(end);
    EXPECT_EQ(end->outcome, Outcome::Done);
    EXPECT_EQ(end->id, answer.id);
    EXPECT_NEAR(poseOf(run, "ground/r1").heading.degrees(), -120, 1e-6);
    // A motion ends the turn, and the trip.
    plan.points = {{1, {9.5, 6}}};
    plan.heading = Angle::degrees(60);
    ASSERT_EQ(run.travel("ground/r1", plan).refusal, "");
    while (distance(poseOf(run, "ground/r1").position, Point2{9.5, 6}) > 0.005) step(run);
    for (int i = 0; i < 20; ++i) step(run);
    EXPECT_EQ(run.endTrip("ground/r1", Outcome::Replaced), "");
    ASSERT_EQ(run.tripEnds().size(), 1U);
    EXPECT_EQ(run.tripEnds().front().outcome, Outcome::Replaced);
}

TEST(Cabin, TheLastRiderInCanAlwaysLeave) {
    const Cabin cabin{.width = 1.8, .length = 1.6, .door = 1};
    // Two side by side at the back: the way of the first passes too near to the second.
    std::vector<Rider> riders = {
        {.id = "r1", .at = {-0.5, 0.6}, .radius = 0.25, .mass = 9, .stop = 1},
        {.id = "r2", .at = {-0.5, 0.05}, .radius = 0.25, .mass = 9, .stop = 1}};
    EXPECT_FALSE(canLeave(cabin, riders, riders[0]));
    EXPECT_TRUE(canLeave(cabin, riders, riders[1]));
    // Random cabins that fill up empty again, whatever the radii.
    for (int k = 0; k < 200; ++k) {
        const Cabin one{.width = 1 + 0.01 * (k % 100), .length = 1.2 + 0.013 * (k % 77), .door = 1};
        std::vector<Rider> inside;
        for (int i = 0; i < 8; ++i) {
            Rider next{.id = std::to_string(i),
                       .at = {},
                       .radius = 0.15 + 0.01 * ((7 * k + 5 * i) % 16),
                       .mass = 9,
                       .stop = 1};
            const auto slot = slotIn(one, inside, next);
            if (!slot) continue;
            next.at = *slot;
            inside.push_back(next);
        }
        while (!inside.empty()) {
            const auto first = std::find_if(inside.begin(), inside.end(), [&](const Rider& rider) {
                return canLeave(one, inside, rider);
            });
            ASSERT_NE(first, inside.end()) << k;
            inside.erase(first);
        }
    }
}

TEST(BuildingRun, TripsOfRecordsBeginWithTheRun) {
    const SiteScene building = buildingOf(
        "robot id=ground/r1 at=6,4 trip=\"8,4;upper/9,6\" pause=2\n"
        "human id=upper/h at=6,4 trip=\"ground/9,6;upper/6,5\" loop=yes\n");
    BuildingRun run(building, optionsOf());
    const auto end = await(run, "ground/r1", 120);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->outcome, Outcome::Done);
    EXPECT_EQ(run.roomOf("ground/r1"), 1U);
    EXPECT_NEAR(distance(poseOf(run, "ground/r1").position, Point2{9, 6}), 0, 0.02);
    // The person goes down and up again and again.
    std::size_t changes = 0;
    std::size_t room = run.roomOf("upper/h").value();
    for (int i = 0; i < 12000; ++i) {
        step(run);
        if (const std::size_t now = run.roomOf("upper/h").value(); now != room) {
            room = now;
            ++changes;
        }
    }
    EXPECT_GT(changes, 6U);
}

TEST(BuildingRun, TripsOfRecordsWithoutAWayAreErrors) {
    const auto error = [](const std::string& layout) -> std::string {
        const SiteScene building = buildingOf(layout);
        try {
            const BuildingRun run(building, optionsOf());
        } catch (const FormatError& failure) {
            return failure.diagnostics().front().message;
        }
        return "";
    };
    EXPECT_EQ(error("robot id=ground/r1 at=6,4 trip=\"uper/9,6\"\n"),
              "ground/r1: no storey `uper`");
    EXPECT_EQ(error("robot id=ground/r1 at=6,4 trip=\"upper/9,6\" path=1,1\n"),
              "ground/r1: give `path` or `trip`, not both");
    EXPECT_NE(error("robot id=ground/r1 at=6,4 trip=\"upper/90,6\"\n").find("no way"),
              std::string::npos);
}

TEST(BuildingRun, ARobotClimbsOnlyIfItsRecordSaysSo) {
    const std::string stairs_only =
        std::string(kBuilding).substr(0, std::string(kBuilding).find("- lift")) +
        "- stairs: {id: s1, storeys: 'ground,upper', at: [4, 1], heading: 0, size: [1.6, 4]}\n";
    const SiteScene building = buildingOf(
        "robot id=ground/r1 at=6,4\nrobot id=ground/r2 at=8,4 climbs=yes\n", stairs_only);
    BuildingRun run(building, optionsOf());
    EXPECT_EQ(run.travel("ground/r1", {{{1, {9, 6}}}}).refusal,
              "no way for ground/r1 to upper/9,6; s1: it does not climb stairs");
    const TripAnswer answer = run.travel("ground/r2", {{{1, {9, 6}}}});
    EXPECT_EQ(answer.refusal, "");
    EXPECT_EQ(answer.via, "s1");
    const auto end = await(run, "ground/r2", 120);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->outcome, Outcome::Done);
    EXPECT_EQ(run.roomOf("ground/r2"), 1U);
}

/// The time that a person takes for the flight up or down, and the fastest pace on it.
TEST(BuildingRun, PeopleTakeStairsAtTheirPace) {
    for (const bool is_up : {true, false}) {
        const SiteScene building =
            buildingOf(is_up ? "human id=ground/h at=6,4\n" : "human id=upper/h at=6,4\n");
        BuildingRun run(building, optionsOf());
        const std::string id = is_up ? "ground/h" : "upper/h";
        ASSERT_EQ(run.travel(id, {{{is_up ? 1U : 0U, {9, 6}}}}).via, "s1");
        double entered = -1, left = -1, fastest = 0;
        const auto end = await(run, id, 60, [&] {
            const double now = seconds(run.world(0).time());
            const std::size_t room = run.roomOf(id).value();
            if (room == 3) {
                if (entered < 0) entered = now;
                fastest = std::max(fastest, run.world(3).status(0).speed);
            } else if (entered >= 0 && left < 0) {
                left = now;
            }
        });
        ASSERT_TRUE(end);
        EXPECT_EQ(end->outcome, Outcome::Done);
        const double pace = is_up ? 0.6 : 0.7;
        EXPECT_NEAR(fastest, pace, 1e-9);
        // A person reaches 1.2 m/s in half a second, and stops like that.
        EXPECT_NEAR(left - entered, 4 / pace + pace / 2.4, 0.3);
    }
}

/// Robots that all want to go up: the load of the cabin never exceeds its capacity, and riders
/// never overlap.
TEST(BuildingRun, TheCabinHoldsNoMoreThanItsCapacity) {
    std::string layout;
    for (int i = 0; i < 6; ++i)
        layout += "robot id=ground/r" + std::to_string(i) +
                  " mass=120 at=" + std::to_string(5 + i) + ",6\n";
    const SiteScene building = buildingOf(layout);
    BuildingRun run(building, optionsOf());
    for (int i = 0; i < 6; ++i)
        ASSERT_EQ(run.travel("ground/r" + std::to_string(i), {{{1, {5.0 + i, 6}}}}).refusal, "");
    std::size_t most = 0;
    std::map<std::string, Outcome> ends;
    while (ends.size() < 6 && seconds(run.world(0).time()) < 600) {
        step(run);
        most = std::max(most, run.world(2).movers().size());
        for (const TripEnd& end : run.tripEnds()) ends[end.mover] = end.outcome;
        ASSERT_TRUE(run.world(2).collisions().empty());
        const LiftState lift = run.lifts().front();
        ASSERT_TRUE(lift.door == 0 || lift.height == 0 || lift.height == 3);
    }
    EXPECT_EQ(most, 2U);
    ASSERT_EQ(ends.size(), 6U);
    for (const auto& [id, outcome] : ends) {
        EXPECT_EQ(outcome, Outcome::Done) << id;
        EXPECT_EQ(run.roomOf(id), 1U);
    }
}

TEST(BuildingRun, GoesThroughPointsOfSeveralStoreys) {
    const SiteScene building = buildingOf("human id=ground/h at=6,4\n");
    BuildingRun run(building, optionsOf());
    const TripAnswer answer = run.travel("ground/h", {{{1, {9, 6}}, {0, {2.5, 7}}}, 1});
    EXPECT_EQ(answer.via, "s1,s1");
    ASSERT_TRUE(await(run, "ground/h", 120));
    EXPECT_EQ(run.roomOf("ground/h"), 0U);
    EXPECT_NEAR(distance(poseOf(run, "ground/h").position, Point2{2.5, 7}), 0, 0.02);
}

TEST(BuildingRun, EndsATripForAnotherCommand) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    ASSERT_EQ(run.ride("ground/r1", "l1", "upper").refusal, "");
    step(run);
    EXPECT_EQ(run.endTrip("ground/r1", Outcome::Stopped), "");
    ASSERT_EQ(run.tripEnds().size(), 1U);
    EXPECT_EQ(run.tripEnds().front().outcome, Outcome::Stopped);
    // In a cabin it cannot be ended.
    ASSERT_EQ(run.ride("ground/r1", "l1", "upper").refusal, "");
    while (run.roomOf("ground/r1") == 0U && seconds(run.world(0).time()) < 60) step(run);
    EXPECT_EQ(run.endTrip("ground/r1", Outcome::Stopped),
              "ground/r1 is in l1: it first goes on to a storey");
    EXPECT_TRUE(await(run, "ground/r1", 120));
    EXPECT_EQ(run.ride("ground/r1", "l2", "upper").refusal, "no lift `l2`");
    EXPECT_EQ(run.ride("ground/r1", "l1", "attic").refusal, "l1 does not stop at `attic`");
    EXPECT_EQ(run.travel("ground/r1", {{{0, {11.9, 4}}}}).refusal,
              "ground/r1 has no room at ground/11.9,4: ground/f stands there");
    EXPECT_EQ(run.travel("ground/r1", {{{2, {1, 4}}}}).refusal,
              "l1 is no storey: RIDE leads by a lift");
}

TEST(BuildingRun, KeepsOdometryAndIdsAcrossRooms) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    ASSERT_EQ(run.travel("ground/r1", {{{1, {9, 6}}}}).id, 1);
    ASSERT_TRUE(await(run, "ground/r1", 120));
    // Without noise, and as both storeys have the frame of the building, as if it had gone on foot.
    const World& world = run.world(1);
    const Pose2 odometry = world.odometry(0).pose;
    EXPECT_NEAR(odometry.position.x, 3, 0.02);
    EXPECT_NEAR(odometry.position.y, 2, 0.02);
    EXPECT_GT(run.travel("ground/r1", {{{0, {9, 6}}}}).id, 1);
}

TEST(BuildingRun, IsTheSameTwice) {
    const auto way = [] {
        const SiteScene building = buildingOf(
            "robot id=ground/r1 at=6,4\nrobot id=upper/r1 at=6,4\nhuman id=upper/h "
            "at=8,6\nlaser id=upper/l on=upper/r1 at=0,0,0.2\n");
        BuildingRun run(building, optionsOf());
        run.travel("ground/r1", {{{1, {9, 6}}}});
        run.travel("upper/r1", {{{0, {9, 6}}}});
        run.travel("upper/h", {{{0, {10, 4}}}});
        std::string text;
        for (int i = 0; i < 9000; ++i) {
            step(run);
            for (const char* id : {"ground/r1", "upper/r1", "upper/h"}) {
                const Pose2 pose = poseOf(run, id);
                text += std::to_string(*run.roomOf(id)) + ' ' + formatDouble(pose.position.x) +
                        ' ' + formatDouble(pose.position.y) + '\n';
            }
        }
        EXPECT_EQ(run.roomOf("ground/r1"), 1U);
        EXPECT_EQ(run.roomOf("upper/r1"), 0U);
        EXPECT_EQ(run.roomOf("upper/h"), 0U);
        // Its laser comes along.
        EXPECT_TRUE(run.world(0).sensorNamed("upper/l"));
        EXPECT_FALSE(run.world(1).sensorNamed("upper/l"));
        return text;
    };
    const std::string first = way();
    EXPECT_TRUE(first == way());
}

TEST(BuildingRun, AnAbandonedTripEndsBehindTheLift) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,4\n");
    BuildingRun run(building, optionsOf());
    ASSERT_EQ(run.travel("ground/r1", {{{1, {9, 6}}}}).refusal, "");
    while (run.roomOf("ground/r1") == 0U && seconds(run.world(0).time()) < 60) step(run);
    ASSERT_EQ(run.rooms()[*run.roomOf("ground/r1")].id, "l1");
    run.abandonTrip("ground/r1");
    const auto end = await(run, "ground/r1", 120);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->outcome, Outcome::Stopped);
    ASSERT_EQ(run.roomOf("ground/r1"), 1U);
    const double from_door = distance(poseOf(run, "ground/r1").position, Point2{2.1, 4});
    EXPECT_GT(from_door, 0.9) << "it leaves the landing to others";
    EXPECT_LT(from_door, 5);
    // On a storey it ends at once.
    ASSERT_EQ(run.travel("ground/r1", {{{1, {9, 6}}}}).refusal, "");
    run.abandonTrip("ground/r1");
    EXPECT_EQ(run.tripEnds().back().outcome, Outcome::Stopped);
}

TEST(BuildingRun, ARiderWhoseLandingIsOccupiedTurnsBack) {
    const SiteScene building = buildingOf(
        "robot id=ground/r1 at=6,4\nrobot id=ground/r2 at=8,4\n"
        "robot id=upper/parked at=2.6,4\nrobot id=upper/r3 at=8,4\n");
    BuildingRun run(building, optionsOf());
    EventLog& events = run.rooms()[0].simulation->events();
    events.want({EventKind::Unreached});
    ASSERT_EQ(run.travel("ground/r1", {{{1, {9, 6}}}}).refusal, "");
    const auto end = await(run, "ground/r1", 300);
    ASSERT_TRUE(end) << "it does not wait for ever";
    EXPECT_EQ(end->outcome, Outcome::Unreached);
    std::vector<Event> told;
    for (std::int64_t i = 0; i < events.next(); ++i)
        if (events.at(i).kind == EventKind::Unreached) told.push_back(events.at(i));
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].id, "ground/r1");
    EXPECT_EQ(told[0].other, "upper");
    EXPECT_EQ(told[0].place, (Point2{9, 6})) << "the goal, not where it clears the landing";
    EXPECT_EQ(run.roomOf("ground/r1"), 0U);
    // The lift serves others once the landing is free.
    ASSERT_EQ(run.travel("upper/parked", {{{1, {9, 7}}}}).refusal, "");
    ASSERT_TRUE(await(run, "upper/parked", 400));
    ASSERT_EQ(run.travel("ground/r2", {{{1, {9, 2}}}}).refusal, "");
    const auto second = await(run, "ground/r2", 600);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->outcome, Outcome::Done);
    EXPECT_EQ(run.roomOf("ground/r2"), 1U);
}

TEST(BuildingRun, AMoverKeptFromTheLandingLeavesTheQueue) {
    for (const char* at : {"2.6,4", "2.9,4"}) {
        const SiteScene building = buildingOf(
            std::string("robot id=ground/r1 at=6,4\nrobot id=ground/parked at=") + at + '\n');
        BuildingRun run(building, optionsOf());
        ASSERT_EQ(run.travel("ground/r1", {{{1, {9, 6}}}}).refusal, "");
        const auto end = await(run, "ground/r1", 300);
        ASSERT_TRUE(end) << at;
        EXPECT_EQ(end->outcome, Outcome::Unreached) << at;
    }
}

/// Both on stairs that are too narrow to pass, and on wide ones.
TEST(BuildingRun, ThoseOnStairsWhoseLandingIsOccupiedTurnBack) {
    for (const char* const width : {"1", "1.6"}) {
        std::string text = kBuilding;
        text.replace(text.find("size: [1.6, 4]"), 14, "size: [" + std::string(width) + ", 4]");
        const SiteScene building = buildingOf(
            "human id=ground/h1 at=6,4\nhuman id=ground/h2 at=7,4\n"
            "robot id=upper/parked at=8,1\n",
            text);
        BuildingRun run(building, optionsOf());
        for (const char* const id : {"ground/h1", "ground/h2"})
            ASSERT_EQ(run.travel(id, {{{1, {9, 6}}}}).via, "s1");
        std::size_t most = 0;
        std::map<std::string, Outcome> ends;
        while (ends.size() < 2 && seconds(run.world(0).time()) < 300) {
            step(run);
            most = std::max(most, run.world(3).movers().size());
            for (const TripEnd& end : run.tripEnds()) ends[end.mover] = end.outcome;
        }
        EXPECT_EQ(most, 2U) << "one waits behind the other";
        ASSERT_EQ(ends.size(), 2U) << "they do not wait for ever";
        for (const auto& [id, outcome] : ends) {
            EXPECT_EQ(outcome, Outcome::Unreached) << id;
            EXPECT_EQ(run.roomOf(id), 0U) << id;
        }
        // The stairs serve others once the landing is free.
        ASSERT_EQ(run.travel("upper/parked", {{{1, {9, 7}}}}).refusal, "");
        ASSERT_TRUE(await(run, "upper/parked", 400));
        ASSERT_EQ(run.travel("ground/h2", {{{1, {9, 2}}}}).refusal, "");
        const auto second = await(run, "ground/h2", 500);
        ASSERT_TRUE(second);
        EXPECT_EQ(second->outcome, Outcome::Done);
    }
}

TEST(Cabin, RidersLeaveAWayOutForOthers) {
    const Cabin cabin{.width = 1.8, .length = 1.8, .door = 1.2, .capacity = 300};
    const Rider a{.id = "a", .at = {}, .radius = 0.3, .mass = 100, .stop = 1};
    std::vector<Rider> riders = {a};
    riders[0].at = slotIn(cabin, {}, a).value();
    Rider b = a;
    b.stop = 2;
    const auto second = slotIn(cabin, riders, b);
    ASSERT_TRUE(second);
    EXPECT_GE(distance(*second, riders[0].at), 0.6);
    riders.push_back(b);
    riders[1].at = *second;
    Rider heavy = a;
    heavy.mass = 101;
    EXPECT_FALSE(slotIn(cabin, riders, heavy));
    Rider wide = a;
    wide.radius = 0.9;
    EXPECT_FALSE(slotIn(cabin, {}, wide));
}

/// The foot of the stairs lies in the corner between a wall and a body that stands for the steps.
TEST(BuildingRun, PeopleReachStairsInACorner) {
    const std::string text =
        "- storey: {id: ground, height: 2.7, records: [{fence: {path: [[0, 0], [12, 0], [12, 4], "
        "[0, 4]], closed: yes}}, {cube: {id: steps, at: [7.64, 2.99], heading: -120, size: [1.7, "
        "1.28, 2.7]}}]}\n"
        "- storey: {id: upper, z: 2.7, height: 2.7, records: [{fence: {path: [[0, 0], [12, 0], "
        "[12, 9], [0, 9]], closed: yes}}]}\n"
        "- stairs: {id: s1, storeys: 'ground,upper', at: [8.07, 3.73], heading: -120, size: [1.28, "
        "1.7]}\n";
    const SiteScene building = buildingOf("human id=ground/h at=2,2\n", text);
    BuildingRun run(building, optionsOf(std::chrono::milliseconds(20)));
    for (const RoomPoint& to : {RoomPoint{1, {3, 5}}, {0, {9, 1}}, {1, {9, 6}}, {0, {2, 2}}}) {
        ASSERT_EQ(run.travel("ground/h", {{to}}).refusal, "");
        const auto end = await(run, "ground/h", seconds(run.world(0).time()) + 60);
        ASSERT_TRUE(end) << to.room;
        EXPECT_EQ(end->outcome, Outcome::Done) << to.room;
    }
}

}  // namespace building_run_test
}  // namespace ispace::passages
