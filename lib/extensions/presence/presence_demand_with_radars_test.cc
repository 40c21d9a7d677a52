// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the search for sensors that detect people on their ways.
#include "extensions/presence/presence_demand.h"

#include <gtest/gtest.h>

#include <memory>

#include "extensions/presence/presence.h"
#include "extensions/radars/radars_test.h"
#include "support/test_arrange.h"

namespace ispace::presence {
namespace presence_demand_with_radars_test {

/// Two halves, which a narrow gap joins.
constexpr const char* kTwoRooms = "#env 1\nispace size=8,6,2.5\nwall from=0,-3 to=0,2.9\n";

/// A person walks through the left half, and another one a third as far in the right half.
PeoplePaths waysInBoth() {
    PathCutter cutter;
    for (int i = 0; i <= 30; ++i) {
        cutter.add("left", i * kPathStep, {-3, -2.5 + 0.15 * i});
        cutter.add("right", i * kPathStep, {3, -2.5 + 0.05 * i});
    }
    return cutter.finish();
}

double presenceOf(const Scene& scene, const std::vector<SensorGroup>& groups,
                  const Arrangement& arrangement, const ArrangeOptions& options) {
    const Scene whole = withPlaced(scene, groups, arrangement.sensors);
    return measurePresence(whole, waysInBoth(), options.plane).all.share;
}

TEST(ArrangePresence, ValueIsTheShareThatCoverageMeasures) {
    const Scene scene = roomScene(kTwoRooms);
    const auto groups = groupsOf(scene, {"radar,range=2"});
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.demand = presenceDemand(std::make_shared<PeoplePaths>(waysInBoth()), 0);
    const Arrangement one = arranged(scene, groups, options);
    ASSERT_TRUE(one.value);
    EXPECT_NEAR(*one.value, presenceOf(scene, groups, one, options), 1e-6);
    EXPECT_NEAR(*one.value, one.bound, 1e-9) << "the search is exact";
    EXPECT_LT(one.sensors.at(0).pose.position.x, 0) << "the way on the left is longer";
    EXPECT_EQ(one.cells, 60U);
}

TEST(ArrangePresence, ATargetIsReachedWithTheFewestInEveryRoom) {
    const Scene scene = roomScene(kTwoRooms);
    const auto groups = groupsOf(scene, {"radar"}, true);
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.demand = presenceDemand(std::make_shared<PeoplePaths>(waysInBoth()), 0);
    options.target = 0.95;
    const Arrangement few = arranged(scene, groups, options);
    EXPECT_TRUE(few.is_reached);
    EXPECT_EQ(few.sensors.size(), 2U) << "a wall separates the ways";
    EXPECT_EQ(few.least.value_or(0), 2);
    EXPECT_GE(presenceOf(scene, groups, few, options), 0.95);
}

TEST(ArrangePresence, CountsSensorsThatStand) {
    const Document layout = layoutFrom("radar id=m1 at=-3.9,0,0.15\n");
    const Scene scene = roomScene(kTwoRooms, &layout);
    const auto groups = groupsOf(scene, {"radar"});
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.demand = presenceDemand(std::make_shared<PeoplePaths>(waysInBoth()), 0);
    const Arrangement other = arranged(scene, groups, options);
    EXPECT_GT(other.sensors.at(0).pose.position.x, 0) << "m1 watches the left";
    EXPECT_NEAR(*other.value, presenceOf(scene, groups, other, options), 1e-6);
}

TEST(ArrangePresence, RefusesSensorsWithoutSenseOfMotionAndWaysOfNobody) {
    const Scene scene = roomScene(kTwoRooms);
    ArrangeOptions options = coarse();
    options.demand = presenceDemand(std::make_shared<PeoplePaths>(waysInBoth()), 0);
    EXPECT_THROW(arranged(scene, groupsOf(scene, {"laser"}), options), UsageError);
    options.demand = presenceDemand(std::make_shared<PeoplePaths>(), 0);
    EXPECT_THROW(arranged(scene, groupsOf(scene, {"radar"}), options), UnmetError);
}

}  // namespace presence_demand_with_radars_test
}  // namespace ispace::presence
