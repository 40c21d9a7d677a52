// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "extensions/passages/building_run.h"
#include "extensions/passages/passages_test.h"
#include "scene/scene.h"

namespace ispace::passages {
namespace standing_room_test {

using testing::buildingOf;
using testing::optionsOf;
using testing::poseOf;

/// Above the ground, turned by 90 degrees: its 1,0 is 12,1 of the building.
constexpr const char* kOpenBuilding =
    "- storey: {id: ground, height: 3, records: [{fence: {id: f, path: [[0, 0], [12, 0], [12, 8], "
    "[0, 8]], closed: yes}}, {cube: {id: box, at: [9, 6], size: [1, 1, 1]}}]}\n"
    "- storey: {id: upper, z: 3, height: 3, at: [12, 0], heading: 90, records: [{fence: {id: f, "
    "path: [[0, 0], [8, 0], [8, 12], [0, 12]], closed: yes}}]}\n"
    "- lift: {id: l1, storeys: 'ground,upper', at: [1.2, 4], heading: 0, size: [1.8, 1.8], door: "
    "1.2}\n"
    "- stairs: {id: s1, storeys: 'ground,upper', at: [4, 1], heading: 0, size: [1.6, 4]}\n"
    "- shaft: {id: atrium, storeys: 'ground,upper', path: [[6, 4], [6, 6], [8, 6], [8, 4]]}\n";

/// Replaces the records of a storey that have this id by others.
void replace(BuildingRun& run, const SiteScene& building, std::size_t storey, const std::string& id,
             const std::string& layout) {
    World& world = run.rooms()[storey].simulation->world();
    std::vector<Record> records;
    for (std::size_t i = 0; i < world.scene().records.size(); ++i)
        if (world.scene().ids[i] != id) records.push_back(world.scene().records[i]);
    for (const Record& record : testing::layoutDocument(layout).records) records.push_back(record);
    world.change(makeScene(std::move(records), world.scene(), building.devices));
}

std::string placed(BuildingRun& run, const std::string& mover, std::size_t storey, Point2 at) {
    return run.place(mover, RoomPoint{storey, at}, std::nullopt);
}

TEST(StandingRoom, IsThatOfThePresentStorey) {
    const SiteScene building =
        buildingOf("robot id=ground/r1 at=6,2\nhuman id=ground/h at=3,6\n", kOpenBuilding);
    BuildingRun run(building, optionsOf());
    for (const char* mover : {"ground/r1", "ground/h"})
        EXPECT_EQ(placed(run, mover, 0, {9, 6}),
                  std::string(mover) + " has no room at ground/9,6: ground/box stands there");
    // It moves, another one comes, and goes.
    replace(run, building, 0, "box", "cube id=box at=10,2 size=1,1,1\n");
    replace(run, building, 1, "", "cube id=crate at=2,3 size=1,1,1\n");
    EXPECT_EQ(placed(run, "ground/r1", 0, {9, 6}), "");
    EXPECT_EQ(placed(run, "ground/r1", 0, {10, 2}),
              "ground/r1 has no room at ground/10,2: ground/box stands there");
    for (const char* mover : {"ground/r1", "ground/h"})
        EXPECT_EQ(placed(run, mover, 1, {2, 3}),
                  std::string(mover) + " has no room at upper/2,3: upper/crate stands there");
    EXPECT_EQ(poseOf(run, "ground/r1").position, (Point2{9, 6}));
    replace(run, building, 1, "crate", "");
    EXPECT_EQ(placed(run, "ground/h", 1, {2, 3}), "");
    EXPECT_EQ(placed(run, "ground/r1", 1, {2, 3}),
              "ground/r1 has no room at upper/2,3: ground/h stands there");
}

TEST(StandingRoom, ChangesWithBodiesThatTripsKnowFromTheStart) {
    const SiteScene building = buildingOf("robot id=ground/r1 at=6,2\n", kOpenBuilding);
    BuildingRun run(building, optionsOf());
    const auto go = [&](Point2 at) { return run.travel("ground/r1", {{{0, at}}}).refusal; };
    EXPECT_EQ(go({9, 6}), "ground/r1 has no room at ground/9,6: ground/box stands there");
    replace(run, building, 0, "box", "");
    EXPECT_EQ(go({9, 6}), "no way for ground/r1 to ground/9,6; s1: it does not climb stairs")
        << "ways are those of the start";
    replace(run, building, 0, "", "cube id=crate at=10,2 size=1,1,1\n");
    EXPECT_EQ(go({10, 2}), "ground/r1 has no room at ground/10,2: ground/crate stands there");
}

TEST(StandingRoom, EndsAtOpenings) {
    const SiteScene building =
        buildingOf("robot id=ground/r1 at=6,2\nhuman id=ground/h at=3,6\n", kOpenBuilding);
    BuildingRun run(building, optionsOf());
    const auto text = [](const std::string& at, const std::string& passage) {
        return "ground/r1 has no room at " + at + ": the floor is open there, for " + passage;
    };
    // Points of the upper storey: x is that of the building's y, y is 12 less the building's x.
    EXPECT_EQ(placed(run, "ground/r1", 1, {5, 5}), text("upper/5,5", "atrium"));
    EXPECT_EQ(placed(run, "ground/r1", 1, {1, 6}), text("upper/1,6", "s1"));
    EXPECT_EQ(placed(run, "ground/r1", 1, {4, 10.8}), text("upper/4,10.8", "l1"));
    EXPECT_EQ(placed(run, "ground/r1", 0, {1.2, 4}), text("ground/1.2,4", "l1"));
    EXPECT_EQ(run.travel("ground/r1", {{{1, {5, 5}}}}).refusal, text("upper/5,5", "atrium"));
    EXPECT_EQ(poseOf(run, "ground/r1").position, (Point2{6, 2}));
    // The rim belongs to the floor, and the lowest floor is whole but for the lift.
    EXPECT_EQ(placed(run, "ground/r1", 1, {5, 6}), "");
    EXPECT_EQ(placed(run, "ground/h", 0, {7, 5}), "");
    EXPECT_EQ(placed(run, "ground/r1", 0, {6, 1}), "");
}

TEST(StandingRoom, IsKeptOnWaysAroundShafts) {
    const SiteScene building = buildingOf("robot id=upper/r1 at=5,2\n", kOpenBuilding);
    BuildingRun run(building, optionsOf());
    // The straight way leads over the atrium, of x from 4 to 6 and y from 4 to 6.
    ASSERT_EQ(run.travel("upper/r1", {{{1, {5, 8}}}}).refusal, "");
    const double radius = building.scenes[1]->robots.front().model.radius;
    const auto apart = [](double at) { return std::max({4 - at, at - 6, 0.0}); };
    for (int i = 0; i < 4000; ++i) {
        testing::step(run);
        const Point2 at = poseOf(run, "upper/r1").position;
        ASSERT_GT(std::hypot(apart(at.x), apart(at.y)), radius) << at.x << ',' << at.y;
    }
    EXPECT_LT(distance(poseOf(run, "upper/r1").position, Point2{5, 8}), 0.05);
    // The ground has floor there.
    const SiteScene below = buildingOf("robot id=ground/r1 at=7,2\n", kOpenBuilding);
    BuildingRun straight(below, optionsOf());
    EXPECT_EQ(straight.travel("ground/r1", {{{0, {7, 5}}}}).refusal, "");
}

TEST(StandingRoom, EndsAtAShaftAcrossTheStorey) {
    std::string text = kOpenBuilding;
    text.replace(text.find("[[6, 4], [6, 6], [8, 6], [8, 4]]"), 32,
                 "[[6, 0], [6, 8], [8, 8], [8, 0]]");
    const SiteScene building = buildingOf("robot id=upper/r1 at=5,2\n", text.c_str());
    BuildingRun run(building, optionsOf());
    EXPECT_EQ(run.travel("upper/r1", {{{1, {5, 8}}}}).refusal.substr(0, 36),
              "no way for upper/r1 to upper/5,8; s1");
    EXPECT_EQ(run.travel("upper/r1", {{{1, {5, 3}}}}).refusal, "");
}

TEST(StandingRoom, EndsRecordedTripsAtOpenings) {
    const SiteScene building =
        buildingOf("human id=ground/h at=3,6 trip=upper/5,5\n", kOpenBuilding);
    try {
        const BuildingRun run(building, optionsOf());
        ADD_FAILURE() << "the trip begins";
    } catch (const FormatError& error) {
        EXPECT_EQ(error.diagnostics().front().message,
                  "ground/h has no room at upper/5,5: the floor is open there, for atrium");
    }
}

TEST(StandingRoom, IsNoMatterForATurnOnTheSpot) {
    const SiteScene building = buildingOf("human id=ground/h at=8.7,6\n", kOpenBuilding);
    BuildingRun run(building, optionsOf());
    EXPECT_EQ(run.place("ground/h", std::nullopt, Angle::degrees(90)), "")
        << "it leans against the box";
    EXPECT_NEAR(poseOf(run, "ground/h").heading.degrees(), 90, 1e-9);
}

}  // namespace standing_room_test
}  // namespace ispace::passages
