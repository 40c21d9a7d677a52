// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/any_place.h"

#include <gtest/gtest.h>

#include <cmath>

#include "place/test_arrange.h"

namespace ispace {
namespace {

/// An empty room of 20 m x 20 m.
Scene hall() { return roomScene("#env 1\nispace size=20,20\n"); }

Receiver receiver(double range) {
    Receiver figures;
    figures.max_range = range;
    return figures;
}

std::size_t cellsSeenFrom(Point2 place, double heading, const Laser& laser, const Grid& grid) {
    Scene scene = hall();
    scene.lasers.push_back(
        {"l", laser, {{place.x, place.y, kScanHeight}, Angle::degrees(heading), {}, {}}});
    Worlds worlds(scene.environment);
    const CoverageOptions options{.columns = grid.columns, .rows = grid.rows, .exact = false};
    return measureCoverage(scene, worlds, options).sensors[0].cells.count();
}

TEST(MostCellsInView, HoldsAnywhereAndIsNearWhereNothingHides) {
    const Grid grid{hall().environment.limits(), 100, 100};
    for (const double fov : {10.0, 90.0, 180.0, 270.0, 359.0}) {
        Laser laser;
        laser.max_range = 4;
        laser.first = Angle::degrees(-fov / 2);
        laser.beams = static_cast<int>(fov) + 1;
        const std::uint64_t most = mostCellsInView(laser, grid);
        std::size_t best = 0;
        for (int i = 0; i < 40; ++i) {
            const Point2 place{-1 + 0.047 * i, 0.031 * i};
            const std::size_t seen = cellsSeenFrom(place, 9.1 * i, laser, grid);
            EXPECT_LE(seen, most) << fov;
            best = std::max(best, seen);
        }
        const double edge = fov / 180 * 3.15 * 4 + 8;  // of the fan, in metres; a cell is 0.2 m
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
    EXPECT_LE(seen, mostCellsInView(laser, grid));
}

TEST(MostCellsInView, IsAtMostAllCells) {
    const Grid grid{hall().environment.limits(), 10, 10};
    Laser laser;
    laser.max_range = 1000;
    EXPECT_EQ(mostCellsInView(laser, grid), 100U);
    EXPECT_EQ(mostCellsInView(receiver(1e6), grid), 100U);
}

TEST(MostFromAnyPlace, TakesTheDearestCellsThatAreMissing) {
    const Grid grid{{{0, 0}, {10, 10}}, 10, 10};
    Problem problem;
    problem.weights.assign(100, 1);
    problem.weights[0] = 50;
    problem.weights[1] = 10;
    problem.met.assign(100, 0);
    problem.met[1] = 1;
    const SensorDevice small = receiver(0.1);
    const std::uint64_t cells = mostCellsInView(small, grid);
    ASSERT_GE(cells, 1U);
    ASSERT_LT(cells, 10U);
    const auto most_of = [&](int number) {
        const SensorDevice devices[] = {small};
        const int most[] = {number};
        problem.kinds = {Kind{}};
        return mostFromAnyPlace(problem, grid, devices, most, 1);
    };
    EXPECT_EQ(most_of(0), 10U) << "what is met already";
    EXPECT_EQ(most_of(1), 10 + 50 + (cells - 1));
    EXPECT_EQ(most_of(200), problem.totalWeight());
    // Twice as much is asked of each cell.
    problem.demand = 2;
    EXPECT_LE(most_of(1), 10 + 50 + cells);
}

TEST(MostFromAnyPlace, ABudgetBuysWhatSeesMostForItsCost) {
    const Grid grid{{{0, 0}, {100, 100}}, 100, 100};
    Problem problem;
    problem.weights.assign(grid.size(), 1);
    problem.met.assign(grid.size(), 0);
    const SensorDevice devices[] = {receiver(2), receiver(4)};
    const std::uint64_t few = mostCellsInView(devices[0], grid),
                        many = mostCellsInView(devices[1], grid);
    ASSERT_GT(many, 2 * few);
    problem.kinds = {Kind{}, Kind{}};
    problem.kinds[1].cost = 2;
    const int most[] = {10, 10};
    problem.budget = 5;
    const std::uint64_t bought = mostFromAnyPlace(problem, grid, devices, most, 1);
    EXPECT_GE(bought, 2 * many + few);
    EXPECT_LE(bought, 5 * many / 2 + 1);
    problem.budget.reset();
    EXPECT_EQ(mostFromAnyPlace(problem, grid, devices, most, 1), 10 * (many + few));
}

}  // namespace
}  // namespace ispace
