// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/candidate_generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "arrange/candidate.h"
#include "base/error.h"
#include "base/file.h"
#include "support/test_arrange.h"
#include "support/test_paths.h"
#include "support/test_problems.h"

namespace ispace {
namespace candidate_pool_test {

/// The candidates of one sensor in a scene.
struct Pooled {
    Scene scene;
    RayScenes worlds;
    Target target;
    std::vector<SensorClass> kinds;
    SilentProgress silent;
    std::unique_ptr<PosedCandidates> set;

    Pooled(Scene made, const char* sensor, const ArrangeOptions& options)
        : scene(std::move(made)),
          worlds(scene.environment),
          target(makeTarget(scene.environment, CellCount{50, 50}, kScanHeight)),
          kinds(kindsOf(groupsOf(scene, {sensor}))) {
        CandidateWeights weights{target.indoor, std::vector<std::uint32_t>(target.grid.size())};
        target.indoor.forEach([&](std::size_t cell) { weights.left[cell] = 1; });
        CandidatePool pool(scene.environment, worlds, target, std::move(weights), options, silent);
        set = pool.make(kinds.front()).set;
    }
};

TEST(CandidatePool, GridHasACandidateForEachHeading) {
    ArrangeOptions options;
    options.strategy = Strategy::Grid;
    options.x = 3;
    options.y = 2;
    options.headings = 4;
    const Pooled pooled(roomScene("#env 1\nispace size=8,6\n"), "laser", options);
    EXPECT_EQ(pooled.set->sites(), 6U);
    EXPECT_EQ(pooled.set->size(), 24U);
    EXPECT_EQ(pooled.set->pose(5).heading, Angle::degrees(90));
    EXPECT_EQ(pooled.set->pose(0).position, (Point3{-2, -1, kScanHeight}));
    // One that sees all around needs no second heading.
    const Pooled round(roomScene("#env 1\nispace size=8,6\n"), "laser,fov=360", options);
    EXPECT_EQ(round.set->size(), 6U);
}

TEST(CandidatePool, RandomDrawsR1AndThenR2PlacesForEachSensor) {
    ArrangeOptions options;
    options.strategy = Strategy::Random;
    options.first_places = 7;
    options.more_places = 3;
    options.headings = 2;
    const Pooled pooled(roomScene(), "laser,range=2:2", options);
    EXPECT_EQ(pooled.set->sites(), 2 * (7U + 3));
    // The last three of each sensor's ten lie about the best of its first seven.
    std::vector<std::uint32_t> left(pooled.target.grid.size(), 1);
    for (std::size_t sensor = 0; sensor < 2; ++sensor) {
        std::vector<std::uint32_t> values(pooled.set->size());
        pooled.set->weighAll(WeightSums(left), values);
        const auto best_of = [&](std::size_t sites) {
            const auto at = [&](std::size_t site) {
                return values.begin() +
                       static_cast<std::ptrdiff_t>(pooled.set->firstOf(10 * sensor + site));
            };
            return static_cast<std::size_t>(std::max_element(at(0), at(sites)) - values.begin());
        };
        const auto place_of = [&](std::size_t candidate) {
            return pooled.set->pose(candidate).position.onFloor();
        };
        for (std::size_t site = 7; site < 10; ++site)
            EXPECT_LE(
                distance(place_of(pooled.set->firstOf(10 * sensor + site)), place_of(best_of(7))),
                2.0 / 5 + 1e-9);
        pooled.set->forEachRun(best_of(10), [&left](const CellRun& run) {
            std::fill(left.begin() + run.first, left.begin() + run.end, 0U);
        });
    }
    options.seed = 1;
    const Pooled other(roomScene(), "laser,range=2:2", options);
    EXPECT_NE(other.set->pose(0).position, pooled.set->pose(0).position);
}

TEST(CandidatePool, RulesHold) {
    ArrangeOptions options = coarse();
    options.density.lattice_step = 0.25;
    options.mount.keep_out = {readZone("left", roomScene().environment)};
    options.mount.clearance = 0.4;
    options.mount.heights = {0.15, 1};
    const Pooled pooled(roomScene(), "laser", options);
    std::set<double> heights;
    for (std::size_t i = 0; i < pooled.set->size(); ++i) {
        const Point3& place = pooled.set->pose(i).position;
        heights.insert(place.z);
        EXPECT_GT(place.x, 0);
        EXPECT_LE(std::max(std::abs(place.x) - 4, std::abs(place.y) - 3), -0.4 + 1e-6);
    }
    EXPECT_EQ(heights, (std::set<double>{0.15, 1}));
    options = coarse();
    options.mount.on = MountOn::Wall;
    const Pooled along(roomScene(), "laser", options);
    for (std::size_t i = 0; i < along.set->size(); ++i) {
        const Point3& place = along.set->pose(i).position;
        EXPECT_GE(std::max(std::abs(place.x) - 4, std::abs(place.y) - 3), -0.0501);
    }
}

TEST(CandidatePool, FramesCarryWhatLooksDown) {
    ArrangeOptions options = coarse();
    options.mount.on = MountOn::Frame;
    const Pooled pooled(
        roomScene("#env 1\nispace size=8,6\ninfra size=4,4 rows=2 cols=2 height=2\n"), "ranger",
        options);
    ASSERT_GT(pooled.set->size(), 0U);
    EXPECT_EQ(pooled.set->pose(0).tilt, Angle::degrees(-90));
    EXPECT_NEAR(pooled.set->pose(0).position.z, 2, 0.1);
    EXPECT_LT(pooled.set->pose(0).position.z, 2);
}

/// Draws random sites of a laser in a part of the room with few valid sites.
CandidatePool::Made drawnIn(const char* zone, int count, Progress& progress) {
    const Scene scene = roomScene();
    RayScenes worlds(scene.environment);
    const Target target = makeTarget(scene.environment, CellCount{50, 50}, kScanHeight);
    ArrangeOptions options;
    options.strategy = Strategy::Random;
    options.first_places = count;
    options.mount.heights = {0.15, 1};
    options.mount.keep_in = {readZone(zone, scene.environment)};
    const CandidateWeights weights{target.indoor,
                                   std::vector<std::uint32_t>(target.grid.size(), 1)};
    CandidatePool pool(scene.environment, worlds, target, weights, options, progress);
    return pool.make(kindsOf(groupsOf(scene, {"laser:2"})).front());
}

TEST(CandidatePool, DrawingEndsWhenProgressSaysSo) {
    StopWhen later(afterAsking(20000));
    const CandidatePool::Made some = drawnIn("rect:0,0,0.2,0.2", 1000, later);
    EXPECT_FALSE(some.is_complete);
    EXPECT_GE(some.set->sites(), 1U) << "what was found is there";
    EXPECT_LE(later.asked, 20000 + 10);

    StopWhen at_once(afterAsking(0));
    const CandidatePool::Made one = drawnIn("rect:-4,-3,4,3", 1000, at_once);
    EXPECT_FALSE(one.is_complete);
    EXPECT_EQ(one.set->sites(), 1U) << "something to choose from there is";
    const CandidatePool::Made only = drawnIn("rect:-4,-3,4,3", 1, at_once);
    EXPECT_FALSE(only.is_complete);
    EXPECT_EQ(only.set->sites(), 1U);
}

TEST(CandidatePool, NoRandomPlaceFoundSoFarIsNotThatThereIsNone) {
    constexpr const char* kNowhere = "rect:9,9,10,10";
    SilentProgress silent;
    EXPECT_THROW(drawnIn(kNowhere, 20, silent), UnmetError);
    for (const int asked : {0, 5000}) {
        StopWhen progress(afterAsking(asked));
        const CandidatePool::Made none = drawnIn(kNowhere, 20, progress);
        EXPECT_FALSE(none.is_complete);
        EXPECT_EQ(none.set->size(), 0U);
        EXPECT_LE(progress.asked, asked + 1010) << "one more place is looked for";
    }
}

/// All candidates of a laser in the room, on a lattice of 0.1 m and along walls, at these heights.
CandidatePool::Made placedIn(const Scene& scene, std::vector<double> heights, Progress& progress) {
    RayScenes worlds(scene.environment);
    const Target target = makeTarget(scene.environment, CellCount{50, 50}, kScanHeight);
    ArrangeOptions options;
    options.density = {0.1, 0.1, 2};
    options.mount.heights = std::move(heights);
    const CandidateWeights weights{target.indoor,
                                   std::vector<std::uint32_t>(target.grid.size(), 1)};
    CandidatePool pool(scene.environment, worlds, target, weights, options, progress);
    return pool.make(kindsOf(groupsOf(scene, {"laser,range=3"})).front());
}

/// Fails unless the candidates are some of these, in their order, and see the same.
void expectSomeOf(const PosedCandidates& some, const PosedCandidates& all) {
    std::size_t i = 0;
    for (std::size_t k = 0; k < some.size(); ++k) {
        while (i < all.size() && all.pose(i) != some.pose(k)) ++i;
        ASSERT_LT(i, all.size()) << "not in the order of all";
        ASSERT_EQ(some.cellsOf(k), all.cellsOf(i));
    }
}

TEST(CandidatePool, WhatIsThereWhenStoppedIsSpreadOverTheRoom) {
    const Scene scene = roomScene();
    SilentProgress silent;
    const CandidatePool::Made all = placedIn(scene, {}, silent);
    ASSERT_TRUE(all.is_complete);
    ASSERT_GT(all.set->sites(), 4000U);
    std::size_t before = 0;
    for (const int asked : {0, 1, 2, 5}) {
        StopWhen progress(afterAsking(asked));
        const CandidatePool::Made some = placedIn(scene, {}, progress);
        EXPECT_FALSE(some.is_complete);
        ASSERT_GE(some.set->sites(), 64U);
        ASSERT_LT(some.set->sites(), all.set->sites());
        EXPECT_GE(some.set->sites(), before);
        before = some.set->sites();
        ASSERT_NO_FATAL_FAILURE(expectSomeOf(*some.set, *all.set));
        std::set<std::pair<int, int>> squares;  // of two metres
        for (std::size_t k = 0; k < some.set->size(); ++k) {
            const Point3 place = some.set->pose(k).position;
            squares.emplace((place.x + 4) / 2, (place.y + 3) / 2);
        }
        EXPECT_EQ(squares.size(), 4U * 3) << "stopped after " << asked;
    }
}

TEST(CandidatePool, WhatIsThereWhenStoppedIsAtAllHeights) {
    StopWhen at_once(afterAsking(0));
    const CandidatePool::Made some = placedIn(roomScene(), {0.15, 1, 2}, at_once);
    EXPECT_FALSE(some.is_complete);
    EXPECT_GE(some.set->sites(), 64U);
    EXPECT_LE(some.set->sites(), 67U);
    std::map<double, int> at;
    for (std::size_t k = 0; k < some.set->size(); ++k) ++at[some.set->pose(k).position.z];
    ASSERT_EQ(at.size(), 3U);
    for (const auto& [height, count] : at) EXPECT_GE(count, 2 * 20) << height;
}

/// Returns sites within 4 x 3 m, row by row.
std::vector<Site> latticeOf(int columns, int rows) {
    std::vector<Site> sites;
    sites.reserve(static_cast<std::size_t>(columns * rows));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            sites.push_back({{column * 4.0 / columns, row * 3.0 / rows}, {Angle()}});
    return sites;
}

TEST(CandidatePool, StoppedAtOnceTheyAreAllOverAnyLattice) {
    const Scene scene = roomScene();
    RayScenes worlds(scene.environment);
    const Grid grid{scene.environment.limits(), 40, 30};
    for (const double tilt : {0, -30}) {  // in a slice, through the mesh
        const VisibleArea sight(scene.environment, 0, &worlds);
        const CandidateViews views(sight, grid, Laser(), {{0, 0, 1}, {}, Angle::degrees(tilt), {}});
        for (const int columns : {8, 16, 20, 32, 64, 89, 100, 160, 233})
            for (const int rows : {8, 30, 34, 64, 144}) {
                const std::vector<Site> sites = latticeOf(columns, rows);
                PosedCandidates set(grid.size());
                StopWhen progress(afterAsking(0));
                EXPECT_EQ(addCandidates(set, views, sites, 1U << 30U, progress),
                          sites.size() == 64);
                ASSERT_EQ(set.sites(), 64U);
                std::set<std::pair<int, int>> parts;  // of 1 x 0.75 m
                for (std::size_t i = 0; i < set.size(); ++i) {
                    const Point3 place = set.pose(i).position;
                    parts.emplace(place.x, place.y / 0.75);
                }
                EXPECT_EQ(parts.size(), 16U) << columns << " x " << rows;
            }
    }
}

TEST(CandidatePool, MeshesAreLeftInBetween) {
    const Scene scene = roomScene();
    RayScenes worlds(scene.environment);
    const Grid grid{scene.environment.limits(), 40, 30};
    const VisibleArea sight(scene.environment, 0, &worlds);
    const CandidateViews views(sight, grid, Laser(), {{0, 0, 1}, {}, Angle::degrees(-30), {}});
    const std::vector<Site> sites = latticeOf(60, 40);
    SilentProgress silent;
    PosedCandidates all(grid.size());
    ASSERT_TRUE(addCandidates(all, views, sites, 1U << 30U, silent));
    ASSERT_EQ(all.sites(), sites.size());
    std::set<std::size_t> sizes;
    for (const int asked : {0, 10, 70, 100, 110, 140, 160, 200, 300, 2000}) {
        StopWhen progress(afterAsking(asked));
        PosedCandidates some(grid.size());
        ASSERT_FALSE(addCandidates(some, views, sites, 1U << 30U, progress));
        ASSERT_GE(some.sites(), 64U);
        ASSERT_NO_FATAL_FAILURE(expectSomeOf(some, all));
        sizes.insert(some.sites());
    }
    EXPECT_GE(sizes.size(), 6U) << "stopped between places, too";
}

// Fig. 4.8: without the Insider Judge the sensor would stand outside, facing the walls.
TEST(CandidatePool, IndoorTestKeepsTheSensorInTheRoom) {
    const Scene scene = roomScene(readAll(testing::sourcePath("share/scenes/l-room.env")));
    const Environment& room = scene.environment;
    std::vector<Site> everywhere;
    for (const Point2 place : gridPlaces(room.limits(), {9, 9}))
        everywhere.push_back({place, headingsAround(8)});
    SilentProgress silent;
    bool is_complete = true;
    const std::vector<Site> inside =
        validSites(SiteValidity(room, SiteRules()), everywhere, silent, is_complete);
    RayScenes worlds(room);
    const Target target = makeTarget(room, CellCount{100, 100}, kScanHeight);
    Laser laser;
    laser.max_range = 4;
    const VisibleArea sight(room, 0, &worlds);
    const CandidateViews views(sight, target.grid, laser, {{0, 0, kScanHeight}, {}, {}, {}});
    // The thesis counts all cells within the limits, indoor or not.
    const WeightSums ones(std::vector<std::uint32_t>(target.grid.size(), 1));
    const auto best_of = [&](const std::vector<Site>& sites) {
        PosedCandidates set(target.grid.size());
        addCandidates(set, views, sites, 1U << 30U, silent);
        std::vector<std::uint32_t> values(set.size());
        set.weighAll(ones, values);
        const auto best = std::max_element(values.begin(), values.end());
        const Pose3 pose = set.pose(static_cast<std::size_t>(best - values.begin()));
        return std::pair{room.indoor().locate(pose.position.onFloor()), *best};
    };
    const auto kept = best_of(inside), misled = best_of(everywhere);
    EXPECT_EQ(kept.first, Side::Inside);
    EXPECT_EQ(misled.first, Side::Outside);
    EXPECT_GT(misled.second, kept.second);
}

}  // namespace candidate_pool_test
}  // namespace ispace
