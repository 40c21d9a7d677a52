// SPDX-License-Identifier: GPL-3.0-or-later
// Tables 4.1 and 5.2 of the thesis, in the scenes that reproduce them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/file.h"
#include "support/test_arrange.h"
#include "support/test_paths.h"

namespace ispace {
namespace thesis_tables_test {

Scene sceneOf(const std::string& file) {
    return roomScene(readAll(testing::sourcePath("share/scenes/") + file));
}

ArrangeOptions asInTheThesis(Strategy strategy) {
    ArrangeOptions options;
    options.strategy = strategy;
    options.search.optimizer = Optimizer::Greedy;
    return options;
}

class Table41 : public ::testing::Test {
  protected:
    /// In per cent, of three lasers of 4 m and 180 degrees.
    double coverage(const ArrangeOptions& options) {
        return 100 * arranged(scene_, groups_, options).coverage;
    }
    double medianOfRandom() {
        constexpr std::uint64_t kSeeds = 101;
        std::vector<double> all;
        ArrangeOptions options = asInTheThesis(Strategy::Random);  // R1 = 20, R2 = 5, Deg = 8
        for (options.seed = 0; options.seed < kSeeds; ++options.seed)
            all.push_back(coverage(options));
        const auto middle = all.begin() + kSeeds / 2;
        std::nth_element(all.begin(), middle, all.end());
        return *middle;
    }

    Scene scene_ = sceneOf("facilities.env");
    std::vector<SensorGroup> groups_ = groupsOf(scene_, {"laser,range=4,fov=180:3"});
};

TEST_F(Table41, HasItsOrderAndItsCoverage) {
    ArrangeOptions grid = asInTheThesis(Strategy::Grid);
    grid.x = grid.y = 11;
    grid.headings = 8;
    ArrangeOptions wall = asInTheThesis(Strategy::Wall);
    wall.dist = 0.05;
    wall.times = 21;
    const double by_grid = coverage(grid), by_wall = coverage(wall);
    EXPECT_NEAR(by_grid, 80.8, 2);
    EXPECT_NEAR(by_wall, 80.6, 2);
    EXPECT_GE(by_grid, by_wall);
    const double by_random = medianOfRandom();
    EXPECT_LT(by_random, by_wall);
    EXPECT_NEAR(by_random, 73.9, 4);
}

TEST(Table52, HasItsPosesAndItsCoverage) {
    const Scene scene = sceneOf("tracking.env");
    ArrangeOptions options = asInTheThesis(Strategy::Wall);
    options.dist = 0.05;
    options.times = 11;
    const Arrangement found =
        arranged(scene, groupsOf(scene, {"laser,range=3,fov=180:2"}), options);
    ASSERT_EQ(found.sensors.size(), 2U);
    constexpr double kWithin = 0.02;
    const Pose3 &first = found.sensors[0].pose, &second = found.sensors[1].pose;
    EXPECT_LE(distance(first.position.onFloor(), Point2{-0.67, 1.45}), kWithin);
    EXPECT_LE(distance(second.position.onFloor(), Point2{-2.13, 0.80}), kWithin);
    // The table's 180 and 135 degrees are the inner normals in its frame.
    EXPECT_NEAR(first.heading.degrees(), -90, 1e-9);
    EXPECT_NEAR(second.heading.degrees(), -45, 1e-9);
    EXPECT_NEAR(100 * found.coverage, 97.4, 1);
}

}  // namespace thesis_tables_test
}  // namespace ispace
