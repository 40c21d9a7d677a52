// SPDX-License-Identifier: GPL-3.0-or-later
// Rules of views as a search applies them.
#include "arrange/view_rules.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "support/test_arrange.h"

namespace ispace {
namespace view_rules_test {

/// Sensors west of x = 0 alone cover its cells.
class WesternCells final : public CoverRule {
  public:
    explicit WesternCells(CellSet cells) : CoverRule(std::move(cells)) {}
    [[nodiscard]] bool isCovered(const SensorModel& /*sensor*/, Point2 place,
                                 std::size_t /*cell*/) const override {
        return place.x < 0;
    }
};

CellSet cellSetOf(std::size_t size, std::initializer_list<std::size_t> cells) {
    CellSet set(size);
    for (const std::size_t cell : cells) set.set(cell);
    return set;
}

TEST(CoverRule, KeepsCellsWithoutConditionAndThoseThatAreCovered) {
    const WesternCells rule(cellSetOf(10, {2, 3, 4}));
    const SensorModel laser = Laser();
    CellParts parts{{{0, 6}, {3, 5}, {7, 9}}, {0, 1, 3}};
    rule.keepCovered(laser, {-1, 0}, parts);
    EXPECT_EQ(cellsOf(parts, 0, 10), cellSetOf(10, {0, 1, 2, 3, 4, 5}));
    rule.keepCovered(laser, {1, 0}, parts);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(cellsOf(parts, 0, 10), cellSetOf(10, {0, 1, 5}));
    EXPECT_EQ(cellsOf(parts, 1, 10), cellSetOf(10, {7, 8}));
    CellSet seen = cellSetOf(10, {1, 2, 9});
    rule.keepCovered(laser, {1, 0}, seen);
    EXPECT_EQ(seen, cellSetOf(10, {1, 9}));
    CellParts beyond{{{3, 6}}, {0, 1}};
    rule.removeAll(beyond);
    EXPECT_EQ(cellsOf(beyond, 0, 10), cellSetOf(10, {5}));
}

const std::string kHall = "#env 1\nispace id=room size=8,6,2.5\n";

TEST(CoverRule, DecidesWhereSensorsStand) {
    const Scene scene = roomScene(kHall);
    ArrangeOptions options = coarse();
    options.cover_rule = [](const Environment&, const Target& target) {
        CellSet all(target.grid.size());
        for (std::size_t i = 0; i < target.grid.size(); ++i) all.set(i);
        return std::make_unique<const WesternCells>(std::move(all));
    };
    const Arrangement found = arranged(scene, groupsOf(scene, {"laser,range=9,fov=360"}), options);
    ASSERT_EQ(found.sensors.size(), 1U);
    EXPECT_LT(found.sensors[0].pose.position.x, 0);
    EXPECT_GT(found.candidate_value, 0.99);
}

TEST(UnseenFloor, LeavesOutCamerasThatSeeIt) {
    const Scene scene = roomScene(kHall + "zone id=desk at=2,1 size=1,1\n");
    ArrangeOptions options = coarse();
    const std::size_t all = arranged(scene, groupsOf(scene, {"camera"}), options).candidates;
    options.unseen = {{"--none", {readZone("desk", scene.environment)}, 0}};
    EXPECT_LT(arranged(scene, groupsOf(scene, {"camera"}), options).candidates, all);
}

TEST(ArrangeOptions, RejectedPosesAreSearchedAgain) {
    const Scene scene = roomScene(kHall);
    ArrangeOptions options = coarse();
    std::vector<Pose3> rejected;
    options.rejected = [&rejected](const ArrangeSite&, const std::vector<SensorGroup>&,
                                   const Arrangement& layout) {
        std::vector<RoomPose> poses;
        if (rejected.size() == 2) return poses;
        for (const Placement& sensor : layout.sensors) {
            rejected.push_back(sensor.pose);
            poses.push_back({0, sensor.pose});
        }
        return poses;
    };
    const Arrangement found = arranged(scene, groupsOf(scene, {"camera"}), options);
    ASSERT_EQ(rejected.size(), 2U);
    ASSERT_EQ(found.sensors.size(), 1U);
    EXPECT_FALSE(rejected[0] == rejected[1]);
    for (const Pose3& pose : rejected) EXPECT_FALSE(found.sensors[0].pose == pose);
}

}  // namespace view_rules_test
}  // namespace ispace
