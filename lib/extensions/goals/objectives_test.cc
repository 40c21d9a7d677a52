// SPDX-License-Identifier: GPL-3.0-or-later
// arrange --objective path and localise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "extensions/goals/cell_floor.h"
#include "extensions/goals/localisation.h"
#include "extensions/goals/localise_search.h"
#include "extensions/goals/path_objective.h"
#include "support/test_arrange.h"

namespace ispace::goals {
namespace objectives_test {

const std::string kGuarded =
    "#env 1\nispace id=room size=10,4,2.5\n"
    "zone id=a path=-5,-2;-4,-2;-4,2;-5,2\nzone id=b path=4,-2;5,-2;5,2;4,2\n";

ArrangeOptions pathOptions(Optimizer optimizer = Optimizer::Swap) {
    ArrangeOptions options = coarse(optimizer);
    options.objective = std::make_shared<const PathObjective>(
        PathChoice{"a", "b"}, StoreyZone{0, "a"}, StoreyZone{0, "b"});
    return options;
}

ArrangeOptions localiseOptions(double within, Optimizer optimizer = Optimizer::Swap) {
    ArrangeOptions options = coarse(optimizer);
    options.objective = std::make_shared<const LocaliseObjective>(within);
    return options;
}

Coverage measuredOf(const Scene& scene) {
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, {});
}

TEST(ArrangePath, ASensorThatReachesAcrossIsSeenByAllWays) {
    // It stands by a wall: in the middle of the corridor it could not reach farther along it.
    const Scene scene = roomScene(kGuarded);
    const auto groups = groupsOf(scene, {"laser,range=5,fov=360"});
    const Arrangement found = arranged(scene, groups, pathOptions());
    ASSERT_EQ(found.sensors.size(), 1U);
    EXPECT_NEAR(*found.whole, 8, 0.2);
    EXPECT_NEAR(found.candidate_value, *found.value, 1e-9);
    EXPECT_GE(found.bound, *found.value);
    const Scene placed = withPlaced(scene, groups, found.sensors);
    const LeastSeenPath way = findLeastSeenPath(placed, measuredOf(placed), {"a", "b"});
    EXPECT_NEAR(*way.seen, *found.value * *found.whole, 0.4);
    EXPECT_GT(*way.seen, 7.4);
}

TEST(ArrangePath, BoundAndExactHoldForAllLayouts) {
    const Scene scene = roomScene(kGuarded + "pillar id=p at=0,0 size=1,1,2.5\n");
    const auto groups = groupsOf(scene, {"laser,range=2.6,fov=180:2"});
    ArrangeOptions options = pathOptions(Optimizer::Exact);
    options.density = {2, 2, 4};
    options.cells = CellSize{0.25};
    const Arrangement exact = arranged(scene, groups, options);
    options.search.optimizer = Optimizer::Swap;
    const Arrangement swaps = arranged(scene, groups, options);
    EXPECT_GE(exact.candidate_value, swaps.candidate_value);
    EXPECT_GE(swaps.bound, exact.candidate_value);
    EXPECT_EQ(exact.candidate_value, exact.bound) << "proven";
    const ArrangeOptions plain = coarse();
    const Arrangement coverage = arranged(scene, groups, plain);
    const Scene covering = withPlaced(scene, groups, coverage.sensors);
    const Scene guarding = withPlaced(scene, groups, exact.sensors);
    EXPECT_GE(*findLeastSeenPath(guarding, measuredOf(guarding), {"a", "b"}).seen,
              *findLeastSeenPath(covering, measuredOf(covering), {"a", "b"}).seen - 0.5);
}

TEST(ArrangePath, TellsOfZonesThatTouchOrThatNoWayJoins) {
    const Scene touching = roomScene(
        "#env 1\nispace id=room size=10,4,2.5\nzone id=a path=-5,-2;0.2,-2;0.2,2;-5,2\n"
        "zone id=b path=0,-2;5,-2;5,2;0,2\n");
    const auto groups = groupsOf(touching, {"laser,range=5,fov=360"});
    EXPECT_THROW(arranged(touching, groups, pathOptions()), UnmetError);
    const Scene walled = roomScene(kGuarded + "pillar id=p at=0,0 size=0.2,4,2.5\n");
    EXPECT_THROW(arranged(walled, groups, pathOptions()), UnmetError);
    EXPECT_THROW(arranged(roomScene(), groups, pathOptions()), UsageError);
}

TEST(CellFloor, WaysAreAsLongAsTheyAre) {
    // Straight along the corridor, and about the end of a wall.
    const auto length = [](const std::string& more) {
        const Scene scene = roomScene(kGuarded + more);
        const Target target = makeTarget(scene.environment, CellSize{0.1}, kScanHeight);
        CellPaths ways;
        EXPECT_EQ(addFloor(scene.environment, target, ways), 0U);
        const std::size_t all = target.grid.size();
        ways.from = freeCellsOf(scene.environment, target, "a", 0, all);
        ways.to = freeCellsOf(scene.environment, target, "b", 0, all);
        const CellPath way = ways.leastSeen([](std::uint32_t) { return true; });
        EXPECT_TRUE(ways.exist());
        std::uint64_t sum = 0;
        for (const PathCell& cell : way.cells) sum += cell.length;
        EXPECT_EQ(sum, way.seen);
        return static_cast<double>(way.seen) * kPathUnit;
    };
    EXPECT_NEAR(length(""), 8, 0.11);
    const double around = length(
        "wall id=w from=0,-2 to=0,1 height=2.5\n"
        "wall id=v from=-1,-1 to=-1,2 height=2.5\n");
    const double shortest = std::hypot(3, 0) + std::hypot(1, 2) + std::hypot(4, 0);
    EXPECT_GT(around, shortest);
    EXPECT_LT(around, 1.028 * shortest + 0.8);
}

TEST(ArrangeLocalise, ValuesAreThoseOfCoverage) {
    const Scene scene = roomScene(kGuarded);
    const auto groups = groupsOf(scene, {"laser,range=20,fov=360,step=1,sigma=0.05:2"});
    const Arrangement found = arranged(scene, groups, localiseOptions(0.2));
    ASSERT_EQ(found.sensors.size(), 2U);
    EXPECT_EQ(found.whole, 0.2);
    const Scene placed = withPlaced(scene, groups, found.sensors);
    const Coverage coverage = measuredOf(placed);
    const Localisation errors = localise(placed, coverage, 0.2);
    EXPECT_NEAR(*errors.mean, (1 - *found.value) * 0.2, 1e-3);
    EXPECT_NEAR(found.candidate_value, *found.value, 1e-6);
    EXPECT_GE(found.bound, *found.value);
    EXPECT_LE(found.bound, 1);
}

TEST(ArrangeLocalise, BeatsTheLayoutsOfCoverageAndKeepsItsBound) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=3,fov=180,sigma=0.05,angle_sigma=2:3"});
    const Arrangement plain = arranged(scene, groups, coarse());
    const Arrangement found = arranged(scene, groups, localiseOptions(0.3));
    const auto mean = [&](const Arrangement& layout) {
        const Scene placed = withPlaced(scene, groups, layout.sensors);
        return *localise(placed, measuredOf(placed), 0.3).mean;
    };
    EXPECT_LE(mean(found), mean(plain) + 1e-3);
    EXPECT_GE(found.bound, found.candidate_value);
    // No layout of single candidates is better than the bound for one.
    const auto one = groupsOf(scene, {"laser,range=3,fov=180,sigma=0.05,angle_sigma=2"});
    const Arrangement single = arranged(scene, one, localiseOptions(0.3, Optimizer::Greedy));
    EXPECT_GE(single.bound, single.candidate_value);
    EXPECT_LE(single.candidate_value, found.candidate_value);
}

TEST(ArrangeLocalise, PlacesReceiversThatHearATagTogether) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"ultrasound,range=8,fov=150,sigma=0.02:4"});
    ArrangeOptions options = localiseOptions(0.5);
    options.mount.on = MountOn::Ceiling;
    const Arrangement found = arranged(scene, groups, options);
    ASSERT_EQ(found.sensors.size(), 4U);
    EXPECT_GT(*found.value, 0.5);
    EXPECT_GE(found.bound, *found.value);
}

}  // namespace objectives_test
}  // namespace ispace::goals
