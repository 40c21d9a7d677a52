// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/candidates.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "cover/visible.h"
#include "layout/schemas.h"
#include "place/arrangement.h"
#include "record/text.h"

namespace ispace {
namespace {

Scene sceneFrom(const std::string& records) {
    const Document document = readRecordText("#env 1\n" + records, "room.env", sceneSchemas());
    return makeScene(document, nullptr, DeviceCatalogue());
}

/// Four metres, half a turn: the laser of the thesis' section 4.6.
Laser thesisLaser() {
    Laser laser;
    laser.max_range = 4;
    return laser;
}

TEST(GridSearch, DefaultsFollowTheThesis) {
    Box2 limits;
    limits.add({0, 0});
    limits.add({9.6, 8});
    const GridSearch search = defaultGridSearch(limits, 4);
    EXPECT_EQ(search.x, 11);  // 9.6 / 4 * 5 - 1 = 11
    EXPECT_EQ(search.y, 9);
    EXPECT_EQ(search.headings, 8);
    const GridSearch least = defaultGridSearch(limits, 100);
    EXPECT_EQ(least.x, 1);
    EXPECT_EQ(least.y, 1);
}

TEST(GridSearch, PlacesAreInteriorCrossings) {
    Box2 limits;
    limits.add({-1, 2});
    limits.add({3, 5});
    const auto places = gridPlaces(limits, {3, 2, 8});
    ASSERT_EQ(places.size(), 6U);
    EXPECT_EQ(places[0], (Point2{0, 3}));
    EXPECT_EQ(places[2], (Point2{2, 3}));
    EXPECT_EQ(places[5], (Point2{2, 4}));
}

TEST(Candidates, EqualWhatCoverageSees) {
    const Scene scene = sceneFrom("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    const SliceSight sight(scene.environment.slice(kScanHeight));
    const Target target = makeTarget(scene.environment, 40, 30, kScanHeight);
    const Pose3 mount{{0, 0, kScanHeight}, {}, {}, {}};
    SilentProgress progress;
    const auto candidates =
        makeCandidates(target.grid, target.indoor, scene.environment, thesisLaser(), mount,
                       {{-2, 0}, {2.5, 1.25}}, 8, progress);
    ASSERT_EQ(candidates.size(), 16U);
    for (const Candidate& candidate : candidates) {
        CellSet seen = cellsSeen(target.grid, sight, {"", thesisLaser(), candidate.pose});
        seen &= target.indoor;
        EXPECT_EQ(candidate.seen, seen);
        EXPECT_GT(candidate.seen.count(), 0U);
    }
}

TEST(Candidates, StandIndoorsAndClearOfObjects) {
    const Scene scene = sceneFrom("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    const Slice slice = scene.environment.slice(kScanHeight);
    EXPECT_TRUE(isStandable(scene.environment, slice, {0, 0}));
    EXPECT_FALSE(isStandable(scene.environment, slice, {1, 1}));
    EXPECT_FALSE(isStandable(scene.environment, slice, {1.5, 1})) << "solids are closed";
    EXPECT_FALSE(isStandable(scene.environment, slice, {4, 0})) << "on the wall";
    EXPECT_FALSE(isStandable(scene.environment, slice, {5, 0}));
}

/// The best single place of the grid by area seen (eq. 4.6), indoors or anywhere.
Candidate bestPlace(const Scene& scene, bool insider_judge) {
    const Environment& environment = scene.environment;
    const Target target = makeTarget(environment, 100, 100, kScanHeight);
    CellSet all(target.grid.size());
    for (std::size_t cell = 0; cell < all.size(); ++cell) all.set(cell);
    auto places = gridPlaces(environment.limits(), {9, 9, 8});  // no line on a wall
    const Slice slice = environment.slice(kScanHeight);
    if (insider_judge)
        std::erase_if(places, [&](Point2 p) { return !isStandable(environment, slice, p); });
    const Pose3 mount{{0, 0, kScanHeight}, {}, {}, {}};
    SilentProgress progress;
    const auto candidates =
        makeCandidates(target.grid, all, environment, thesisLaser(), mount, places, 8, progress);
    return *std::max_element(
        candidates.begin(), candidates.end(),
        [](const Candidate& a, const Candidate& b) { return a.seen.count() < b.seen.count(); });
}

// Fig. 4.8: without the Insider Judge the sensor would stand outside, facing the walls.
TEST(Candidates, InsiderJudgeKeepsTheSensorInTheRoom) {
    const std::string text = readAll(ISPACE_SOURCE_DIR "/share/scenes/l-room.env");
    const Scene scene =
        makeScene(readRecordText(text, "l-room.env", sceneSchemas()), nullptr, DeviceCatalogue());
    const Candidate inside = bestPlace(scene, true), anywhere = bestPlace(scene, false);
    EXPECT_EQ(scene.environment.indoor().locate(inside.pose.position.onFloor()), Side::Inside);
    EXPECT_EQ(scene.environment.indoor().locate(anywhere.pose.position.onFloor()), Side::Outside);
    EXPECT_GT(anywhere.seen.count(), inside.seen.count());
}

}  // namespace
}  // namespace ispace
