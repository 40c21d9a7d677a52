// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/coverage_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "coverage/visible_area.h"
#include "support/test_arrange.h"

namespace ispace {
namespace pose_free_bound_test {

/// An empty room of 20 m x 20 m.
Scene hall() { return roomScene("#env 1\nispace size=20,20\n"); }

Receiver receiver(double range) {
    Receiver receiver;
    receiver.max_range = range;
    return receiver;
}

std::size_t cellsSeenFrom(Point2 place, double heading, const Laser& laser, const Grid& grid) {
    Scene scene = hall();
    scene.sensors.push_back(
        {"l", laser, {{place.x, place.y, kScanHeight}, Angle::degrees(heading), {}, {}}});
    RayScenes worlds(scene.environment);
    const CoverageOptions options{.cells = CellCount{grid.columns, grid.rows}, .exact = false};
    return measureCoverage(scene, worlds, options).sensors[0].cells.count();
}

TEST(MostCellsInView, HoldsAnywhereAndIsNearWhereNothingHides) {
    const Grid grid{hall().environment.limits(), 100, 100};
    for (const double fov : {10.0, 90.0, 180.0, 270.0, 359.0}) {
        Laser laser;
        laser.max_range = 4;
        laser.first = Angle::degrees(-fov / 2);
        laser.beams = static_cast<int>(fov) + 1;
        const std::uint64_t most = maxCellsInView(laser, grid);
        std::size_t best = 0;
        for (int i = 0; i < 40; ++i) {
            const Point2 place{-1 + 0.047 * i, 0.031 * i};
            const std::size_t seen = cellsSeenFrom(place, 9.1 * i, laser, grid);
            EXPECT_LE(seen, most) << fov;
            best = std::max(best, seen);
        }
        const double edge = fov / 180 * 3.15 * 4 + 8;  // of the sector, in metres; a cell is 0.2 m
        EXPECT_GE(static_cast<double>(best), static_cast<double>(most) - edge / 0.2 - 10) << fov;
    }
}

TEST(MostCellsInView, ANarrowFanMayRunAlongARowOfCenters) {
    const Grid grid{hall().environment.limits(), 100, 100};
    Laser laser;
    laser.max_range = 4;
    laser.first = Angle::degrees(-0.5);
    laser.beams = 2;
    const std::size_t seen = cellsSeenFrom({0.1, 0.1}, 0, laser, grid);
    EXPECT_GE(seen, 20U);
    EXPECT_LE(seen, maxCellsInView(laser, grid));
}

constexpr double kPlane = 0.3;  // height of the covered plane

/// Poses in the middle of a hall, turned in every way.
class PoseSource {
  public:
    explicit PoseSource(unsigned seed) : random_(seed) {}
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    Angle turn(double most) { return Angle::degrees(between(-most, most)); }
    Pose3 pose(double height) {
        const Point3 place{between(-1, 1), between(-1, 1), height};
        // Looking straight down, or in the plane itself, most of it is in view.
        const double way = between(0, 1);
        if (height == kPlane) return {place, turn(180), {}, Angle::degrees(way < 0.5 ? 0 : 90)};
        if (way < 0.4) return {place, turn(180), Angle::degrees(-90), turn(180)};
        return {place, turn(180), turn(180), turn(180)};
    }

  private:
    std::mt19937_64 random_;
};

/// Cells of the hall that a device sees from random poses, over or in the plane: never more than
/// most. Returns the largest share of that.
template <typename PlacedRecord, typename Model>
double fullestView(const Model& model, double max_height, unsigned seed) {
    static const Scene kHall = hall();
    static RayScenes worlds(kHall.environment);
    static const VisibleArea sight(kHall.environment, kPlane, &worlds);
    const Grid grid{kHall.environment.limits(), 80, 90};
    const auto most = static_cast<double>(maxCellsInView(model, grid));
    PoseSource poses(seed);
    double fullest = 0;
    for (int i = 0; i < 300; ++i) {
        const double above = i % 6 == 0 ? 0 : poses.between(0, max_height);
        const PlacedRecord placed{"s", model, poses.pose(kPlane + above)};
        sight.prepare(placed);
        const auto seen = static_cast<double>(sight.cellsOf(grid, placed).count());
        EXPECT_LE(seen, most) << seed << ": " << i;
        fullest = std::max(fullest, seen / most);
    }
    return fullest;
}

TEST(MostCellsInView, HoldsForRangersThatLookAnyWay) {
    struct Case {
        Projection projection;
        bool measures_depth;
        double fov_x, fov_y, range;
        double least;  ///< share of the bound that some pose comes to
    };
    using enum Projection;
    const Case cases[] = {
        {Pinhole, true, 140, 130, 0.8, 0.7},  {Pinhole, true, 47.5, 39.6, 3, 0.5},
        {Pinhole, true, 120, 2, 2, 0.6},      {Pinhole, true, 1, 100, 3, 0.7},
        {Pinhole, false, 140, 130, 3, 0.7},   {Pinhole, false, 47.5, 39.6, 4, 0.4},
        {Pinhole, false, 0.1, 120, 4, 0.3},   {Spherical, false, 360, 30, 3, 0.8},
        {Spherical, false, 360, 180, 3, 0.8}, {Spherical, false, 90, 90, 4, 0.2},
    };
    unsigned seed = 0;
    for (const Case& one : cases) {
        Ranger ranger;
        ranger.projection = one.projection;
        ranger.measures_depth = one.measures_depth;
        ranger.fov_x = Angle::degrees(one.fov_x);
        ranger.fov_y = Angle::degrees(one.fov_y);
        ranger.max_range = one.range;
        const double share = fullestView<Sensor>(ranger, one.range, ++seed);
        EXPECT_GE(share, one.least) << seed;
    }
}

TEST(MostCellsInView, HoldsForLasersThatTiltRollAndSweep) {
    unsigned seed = 100;
    for (const SweepAxis axis :
         {SweepAxis::None, SweepAxis::Heading, SweepAxis::Tilt, SweepAxis::Roll})
        for (const double fov : {2.0, 120.0, 300.0, 360.0}) {
            Laser laser;
            laser.max_range = 4;
            laser.first = Angle::degrees(-fov / 2);
            laser.beams = static_cast<int>(fov) + 1;
            laser.sweep = axis;
            laser.sweep_span = Angle::degrees(180);
            fullestView<Sensor>(laser, 4, ++seed);
        }
}

// The picture's corners are farther away than the range, which is that along the axis.
TEST(MostCellsInView, DepthReachesBeyondTheRange) {
    const Grid grid{hall().environment.limits(), 100, 100};
    Ranger ranger;
    ranger.max_range = 2;
    ranger.fov_x = ranger.fov_y = Angle::degrees(90);
    const std::uint64_t by_distance = maxCellsInView(ranger, grid);
    EXPECT_LE(by_distance, 400U) << "the disc of the range has 314 cells";
    ranger.measures_depth = true;
    EXPECT_GE(maxCellsInView(ranger, grid), 400U) << "4 m x 4 m, looking down";
    ranger.fov_x = ranger.fov_y = Angle::degrees(179.9999);
    EXPECT_EQ(maxCellsInView(ranger, grid), grid.size());
}

TEST(MostCellsInView, IsAtMostAllCells) {
    const Grid grid{hall().environment.limits(), 10, 10};
    Laser laser;
    laser.max_range = 1000;
    EXPECT_EQ(maxCellsInView(laser, grid), 100U);
    EXPECT_EQ(maxCellsInView(receiver(1e6), grid), 100U);
}

TEST(MostFromAnyPlace, TakesTheDearestCellsThatAreMissing) {
    const Grid grid{{{0, 0}, {10, 10}}, 10, 10};
    Problem problem;
    problem.weights.assign(100, 1);
    problem.weights[0] = 50;
    problem.weights[1] = 10;
    problem.achieved.assign(100, 0);
    problem.achieved[1] = 1;
    const SensorModel small = receiver(0.1);
    const std::uint64_t cells = maxCellsInView(small, grid);
    ASSERT_GE(cells, 1U);
    ASSERT_LT(cells, 10U);
    const auto most_of = [&](int number) {
        const std::uint64_t in_view[] = {cells};
        const int most[] = {number};
        problem.kinds = {SensorType{}};
        return maxFromAnyPlace(problem, in_view, most);
    };
    EXPECT_EQ(most_of(0), 10U) << "what is met already";
    EXPECT_EQ(most_of(1), 10 + 50 + (cells - 1));
    EXPECT_EQ(most_of(200), problem.totalWeight());
    // Twice as much is asked of each cell.
    problem.required = 2;
    EXPECT_LE(most_of(1), 10 + 50 + cells);
}

TEST(MostFromAnyPlace, HoldsForWhatIsRefined) {
    const Scene scene = roomScene("#env 1\nispace size=20,16 height=4\n");
    ArrangeOptions options;
    options.density = {8, 8, 1};
    options.search.optimizer = Optimizer::Greedy;
    options.refine = true;
    options.mount.heights = {2.5};
    options.mount.tilts = {Angle::degrees(-90)};
    const auto groups = groupsOf(scene, {"ranger,range=2.6,fov=140,130,measures=depth"});
    const Arrangement arrangement = arranged(scene, groups, options);
    EXPECT_GT(arrangement.coverage, 0.45);
    EXPECT_GE(arrangement.bound, arrangement.coverage);
    EXPECT_LT(arrangement.bound, 0.6);
}

TEST(MostFromAnyPlace, ABudgetBuysWhatSeesMostForItsCost) {
    const Grid grid{{{0, 0}, {100, 100}}, 100, 100};
    Problem problem;
    problem.weights.assign(grid.size(), 1);
    problem.achieved.assign(grid.size(), 0);
    const std::uint64_t few = maxCellsInView(receiver(2), grid),
                        many = maxCellsInView(receiver(4), grid);
    const std::uint64_t in_view[] = {few, many};
    ASSERT_GT(many, 2 * few);
    problem.kinds = {SensorType{}, SensorType{}};
    problem.kinds[1].cost = 2;
    const int most[] = {10, 10};
    problem.budget = 5;
    const std::uint64_t bought = maxFromAnyPlace(problem, in_view, most);
    EXPECT_GE(bought, 2 * many + few);
    EXPECT_LE(bought, 5 * many / 2 + 1);
    problem.budget.reset();
    EXPECT_EQ(maxFromAnyPlace(problem, in_view, most), 10 * (many + few));
}

}  // namespace pose_free_bound_test
}  // namespace ispace
