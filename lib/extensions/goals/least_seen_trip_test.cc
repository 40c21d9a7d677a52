// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/least_seen_trip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "arrange/arrange.h"
#include "base/error.h"
#include "extensions/goals/path_objective.h"
#include "scene/placement_schemas.h"
#include "site/site_scene.h"
#include "site/storeys.h"
#include "support/test_arrange_building.h"

namespace ispace::goals {
namespace least_seen_trip_test {

/// Two storeys of 12 m by 8 m. The zone `a` lies in the west below, `b` in the west above.
/// \param ground,upper further records of the storeys \param passages further records
SiteScene house(const std::string& ground, const std::string& upper, const std::string& passages) {
    const std::string room =
        "records: [{fence: {path: [[0, 0], [12, 0], [12, 8], [0, 8]], closed: yes}}, ";
    return makeSiteScene(
        readBuilding("- storey: {id: g, height: 3, " + room +
                         "{zone: {id: a, at: [1, 4], size: 1 x 1}}" + ground +
                         "]}\n- storey: {id: u, z: 3, height: 3, " + room +
                         "{zone: {id: b, at: [1, 4], size: 1 x 1}}" + upper + "]}\n" + passages,
                     "house.yaml", {}),
        {}, {});
}

constexpr const char* kSouth =
    "- stairs: {id: south, storeys: 'g,u', at: [6, 1.2], heading: 0, size: [1.2, 3]}\n";
constexpr const char* kNorth =
    "- stairs: {id: north, storeys: 'g,u', at: [6, 6.8], heading: 0, size: [1.2, 3]}\n";
/// A level laser that sees all that lies south of y = 3 and east of x = 3.
constexpr const char* kWatched =
    ", {laser: {id: l, at: [3, 0.1, 0.15], heading: 22, fov: 44, range: 12}}";

LeastSeenTrip tripIn(const SiteScene& building, const PathChoice& of) {
    return findLeastSeenTrip(building, measureSite(building, {}), of);
}

TEST(LeastSeenTrip, TakesTheStairsThatAreNotWatched) {
    const SiteScene building = house(kWatched, "", std::string(kSouth) + kNorth);
    const LeastSeenTrip trip = tripIn(building, {"g/a", "u/b"});
    ASSERT_TRUE(trip.whole.exists);
    EXPECT_EQ(trip.whole.seen, 0);
    ASSERT_EQ(trip.parts.size(), 2U);
    EXPECT_EQ(trip.parts[0].storey, 0U);
    EXPECT_EQ(trip.parts[0].way.of.from, "g/a");
    EXPECT_EQ(trip.parts[0].way.of.to, "north");
    EXPECT_EQ(trip.parts[1].way.of.from, "north");
    EXPECT_EQ(trip.parts[1].way.of.to, "u/b");
    EXPECT_DOUBLE_EQ(trip.whole.length, trip.parts[0].way.length + trip.parts[1].way.length);
}

TEST(LeastSeenTrip, IsSeenWhereTheOnlyStairsAreWatched) {
    const SiteScene building = house(kWatched, "", kSouth);
    const LeastSeenTrip trip = tripIn(building, {"g/a", "u/b"});
    ASSERT_TRUE(trip.whole.exists);
    EXPECT_GT(trip.whole.seen.value(), 0.5);
    EXPECT_EQ(trip.parts[1].way.seen, 0) << "the storey above has no sensor";
    EXPECT_DOUBLE_EQ(*trip.whole.seen, trip.parts[0].way.seen.value());
    // A further way never makes it worse, and the way back is seen as long.
    const LeastSeenTrip back = tripIn(building, {"u/b", "g/a"});
    EXPECT_NEAR(*back.whole.seen, *trip.whole.seen, 1e-9);
    const LeastSeenTrip both =
        tripIn(house(kWatched, "", std::string(kSouth) + kNorth), {"g/a", "u/b"});
    EXPECT_LE(*both.whole.seen, *trip.whole.seen);
}

TEST(LeastSeenTrip, OfOneStoreyIsItsLeastSeenWay) {
    const SiteScene building =
        house(", {zone: {id: c, at: [11, 1], size: 1 x 1}}" + std::string(kWatched), "", kNorth);
    const SiteCoverage coverage = measureSite(building, {});
    const LeastSeenTrip trip = findLeastSeenTrip(building, coverage, {"a", "c"});
    const LeastSeenPath way =
        findLeastSeenPath(*coverage.floors[0], coverage.storeys[0], {"a", "c"});
    EXPECT_EQ(trip.whole.of.from, "g/a");
    EXPECT_EQ(trip.whole.seen, way.seen);
    EXPECT_DOUBLE_EQ(trip.whole.length, way.length);
    ASSERT_EQ(trip.parts.size(), 1U);
    EXPECT_EQ(trip.parts[0].way.pieces.size(), way.pieces.size());
}

TEST(LeastSeenTrip, MayLeadOverAnotherStorey) {
    // A wall with a watched gap divides the storey below.
    const std::string wall =
        ", {wall: {from: [8, 0], to: [8, 5.8]}}, {wall: {from: [8, 6.3], to: [8, 8]}}"
        ", {laser: {id: l, at: [8, 5.9, 0.15], heading: 90, fov: 360, range: 2}}"
        ", {zone: {id: c, at: [11, 4], size: 1 x 1}}";
    const char* const stairs =
        "- stairs: {id: west, storeys: 'g,u', at: [3, 1.2], heading: 0, size: [1.2, 3]}\n"
        "- stairs: {id: east, storeys: 'g,u', at: [9, 1.2], heading: 90, size: [1.2, 3]}\n";
    const LeastSeenTrip trip = tripIn(house(wall, "", stairs), {"g/a", "g/c"});
    ASSERT_TRUE(trip.whole.exists);
    EXPECT_EQ(trip.whole.seen, 0);
    ASSERT_EQ(trip.parts.size(), 3U);
    EXPECT_EQ(trip.parts[1].storey, 1U);
    EXPECT_EQ(trip.parts[1].way.of.from, "west");
    EXPECT_EQ(trip.parts[1].way.of.to, "east");
}

TEST(LeastSeenTrip, NeedsAWay) {
    EXPECT_FALSE(tripIn(house("", "", ""), {"g/a", "u/b"}).whole.exists);
    const SiteScene building = house("", ", {zone: {id: a, at: [9, 4], size: 1 x 1}}", kSouth);
    EXPECT_THROW(tripIn(building, {"a", "b"}), UsageError) << "two storeys have it";
    EXPECT_THROW(tripIn(building, {"g/b", "u/b"}), UsageError);
}

/// Goals and options of arrange --objective path.
ArrangedBuilding guarded(const SiteScene& building, int count, Optimizer optimizer, double fov,
                         std::vector<RoomGoals> goals = std::vector<RoomGoals>(2)) {
    ArrangeOptions options;
    options.strategy = goals[0].places.empty() ? Strategy::All : Strategy::List;
    options.density = {2, 2, 4};
    options.cells.emplace(CellSize{0.2});
    options.search.optimizer = optimizer;
    options.objective =
        std::make_shared<const PathObjective>(PathChoice{"g/a", "u/b"}, StoreyZone{0, "a"},
                                              StoreyZone{1, "b"}, passages::sitePassages(building));
    Record record(*sceneSchemas().find("laser"));
    record.set("range", Tuple{4});
    record.set("fov", fov);
    return arrangedIn(building, {{record, count}}, options, std::move(goals));
}

double seenOn(const SiteScene& building) { return *tripIn(building, {"g/a", "u/b"}).whole.seen; }

TEST(LeastSeenLayout, IsSeenForAsLongAsCoverageSays) {
    const SiteScene building = house("", "", std::string(kSouth) + kNorth);
    for (const int count : {1, 3}) {
        const ArrangedBuilding result = guarded(building, count, Optimizer::Swap, 360);
        const double seen = seenOn(written(building, result));
        ASSERT_TRUE(result.found.value && result.found.whole);
        EXPECT_NEAR(*result.found.value * *result.found.whole, seen, 0.05 * *result.found.whole);
        EXPECT_GE(result.found.bound, *result.found.value - 1e-9);
        if (count == 3) {
            EXPECT_GT(seen, 0.5);
        }
    }
}

TEST(LeastSeenLayout, EqualsBruteForce) {
    const SiteScene building = house("", "", kSouth);
    std::vector<RoomGoals> goals(2);
    goals[0].places = {{{1, 1.5}, {Angle()}}, {{5, 1.2}, {Angle::degrees(180)}}};
    goals[1].places = {{{1, 2}, {Angle(), Angle::degrees(90)}}};
    for (const int count : {1, 2}) {
        const ArrangedBuilding result = guarded(building, count, Optimizer::Exact, 180, goals);
        double best = 0;
        std::vector<std::pair<std::size_t, Pose3>> poses;
        for (std::size_t room = 0; room < 2; ++room)
            for (const Site& site : goals[room].places)
                for (const Angle heading : site.headings)
                    poses.push_back({room, {{site.place.x, site.place.y, 0.15}, heading, {}, {}}});
        for (std::size_t i = 0; i < poses.size(); ++i)
            for (std::size_t k = count == 1 ? i : i + 1; k < (count == 1 ? i + 1 : poses.size());
                 ++k) {
                SiteScene placed = building;
                for (const std::size_t one : std::set<std::size_t>{i, k}) {
                    Scene scene = *placed.scenes[poses[one].first];
                    Sensor sensor{"s" + std::to_string(one), result.groups.front().model,
                                  poses[one].second};
                    scene.sensors.push_back(sensor);
                    placed.scenes[poses[one].first] = std::make_shared<const Scene>(scene);
                }
                best = std::max(best, seenOn(placed));
            }
        const double found = seenOn(written(building, result));
        EXPECT_NEAR(found, best, 0.05 * *result.found.whole) << count;
        EXPECT_GE(result.found.bound * *result.found.whole, best - 0.05 * *result.found.whole);
        EXPECT_GT(best, 0);
    }
}

TEST(LeastSeenLayout, NeedsAWay) {
    EXPECT_THROW(guarded(house("", "", ""), 1, Optimizer::Swap, 360), UnmetError);
}

}  // namespace least_seen_trip_test
}  // namespace ispace::goals
