// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/error.h"
#include "support/test_scenes.h"

namespace ispace {
namespace coverage_test {

TEST(Coverage, EmptyConvexRoomSeenWholeIsCoveredWhole) {
    for (const std::string room :
         {"ispace size=6,4", "fence path=-3,-1;2,-2;4,1;0,3;-2,2 closed=yes"}) {
        const Coverage coverage = coverageOf(sceneOf(room + "\nlaser at=0,0 range=20 fov=360\n"));
        EXPECT_EQ(coverage.report.coverage.grid, 1.0) << room;
        EXPECT_EQ(coverage.report.free_coverage.grid, 1.0) << room;
        EXPECT_EQ(coverage.report.redundancy, (std::vector<double>{0, 1})) << room;
    }
}

TEST(Coverage, HalfPlaneFanInTheMiddleCoversHalf) {
    for (const int cells : {100, 101}) {
        for (const double heading : {0.0, 90.0, 180.0, -90.0}) {
            const Scene scene = sceneOf(
                "ispace size=6,6\nlaser at=0,0 range=20 heading=" + std::to_string(heading) + "\n");
            EXPECT_NEAR(*coverageOf(scene, cells, cells).report.coverage.grid, 0.5, 1.0 / cells)
                << cells << ' ' << heading;
        }
    }
}

TEST(Coverage, NoSensorCoversNothing) {
    const Coverage coverage = coverageOf(sceneOf("ispace size=6,4"));
    EXPECT_EQ(coverage.report.coverage.grid, 0.0);
    EXPECT_EQ(coverage.report.total_effective_area.grid, 0.0);
    EXPECT_EQ(coverage.report.redundancy, (std::vector<double>{1}));
    EXPECT_TRUE(coverage.report.sensors.empty());
}

TEST(Coverage, AreasAreExact) {
    const CoverageReport report =
        coverageOf(
            sceneOf("ispace size=6,4\ncube at=1,1 size=1,0.5,1\ncube at=-1,1,1 size=1,1,1\n"))
            .report;
    EXPECT_NEAR(report.indoor_area, 24, 1e-12);
    EXPECT_NEAR(report.free_area, 23.5, 1e-12);
    EXPECT_EQ(report.height, kScanHeight);
    EXPECT_EQ(report.limits, (Box2{{-3, -2}, {3, 2}}));
    EXPECT_EQ(report.grid.columns, 100);
}

const char* const kOffice =
    "fence path=0,0;8,0;8,6;3,6;3,5;0,5 closed=yes\ninside at=1,1\n"
    "desk at=2,3 heading=30 size=1.2,0.8,0.7\ncube at=4,2 size=0.5,0.5,0.5\n"
    "laser id=a at=0.1,2.5\nlaser id=b at=7.9,3 heading=180 range=4\n"
    "laser id=c at=3.5,5.9 heading=-90 fov=240\n"
    "laser id=d at=7,0.3,1.5 heading=120 fov=90 tilt=-20\n";

TEST(Coverage, MetricsFitTogether) {
    const Coverage coverage = coverageOf(sceneOf(kOffice), 80, 60);
    const CoverageReport& report = coverage.report;
    ASSERT_EQ(report.redundancy.size(), 5U);
    EXPECT_NEAR(std::accumulate(report.redundancy.begin(), report.redundancy.end(), 0.0), 1, 1e-12);
    EXPECT_NEAR(*report.coverage.grid, 1 - report.redundancy[0], 1e-12);
    EXPECT_GT(*report.free_coverage.grid, *report.coverage.grid);  // no laser sees into solids

    CellSet all(coverage.target.grid.size());
    for (const CoveredSet& set : coverage.sets) all |= set.cells;
    const double cell_area = coverage.target.grid.cellArea();
    EXPECT_DOUBLE_EQ(*report.total_effective_area.grid,
                     static_cast<double>(all.count()) * cell_area);
    double marginal_sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        CellSet others(coverage.target.grid.size());
        for (std::size_t j = 0; j < 4; ++j)
            if (j != i) others |= coverage.sets[j].cells;
        EXPECT_NEAR(*report.sensors[i].marginal.grid,
                    static_cast<double>(all.count() - others.count()) * cell_area, 1e-9);
        marginal_sum += *report.sensors[i].marginal.grid;
    }
    EXPECT_LE(marginal_sum, *report.total_effective_area.grid);
    EXPECT_EQ(report.sensors[1].id, "b");
}

TEST(Coverage, TwoEqualSensorsHaveNoMarginalArea) {
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=6,4\nlaser at=1,1 range=3\nlaser at=1,1 range=3\n")).report;
    EXPECT_EQ(report.sensors[0].marginal.grid, 0.0);
    EXPECT_EQ(report.sensors[1].marginal.grid, 0.0);
    EXPECT_EQ(report.redundancy[1], 0);
    EXPECT_EQ(report.redundancy[2], *report.coverage.grid);
}

TEST(Coverage, LoneSensorIsWorthAllItSees) {
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=12,12\nlaser at=0,0 range=4 fov=180\n")).report;
    EXPECT_EQ(report.sensors[0].marginal.grid, *report.total_effective_area.grid);
    EXPECT_NEAR(*report.total_effective_area.grid, std::acos(-1.0) * 8, 0.4);
    // 181 beams, each worth a sector of one degree.
    EXPECT_NEAR(*report.sensors[0].slice_area, std::acos(-1.0) * 16 * 181 / 360, 1e-9);
}

TEST(Coverage, OneCellWillDo) {
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=6,4\nlaser at=1,1 fov=360\n"), 1, 1).report;
    EXPECT_EQ(report.coverage.grid, 1.0);
    EXPECT_EQ(report.total_effective_area.grid, 24.0);
}

TEST(MakeTarget, RefusesGridsOfNoOrTooManyCells) {
    const Scene scene = sceneOf("ispace size=6,4");
    for (const auto& [columns, rows] :
         std::vector<std::pair<int, int>>{{0, 5}, {5, 0}, {-1, -1}, {kMaxCells, 2}, {2, kMaxCells}})
        EXPECT_THROW(makeTarget(scene.environment, CellCount{columns, rows}, 0.15), UsageError)
            << columns << ' ' << rows;
}

TEST(MakeTarget, FreeIsIndoorLessSolidsAtTheHeight) {
    const Scene scene = sceneOf("ispace size=6,4\ncube at=0,0 size=3,2,1\n");
    const Target low = makeTarget(scene.environment, CellCount{60, 40}, 0.15);
    EXPECT_EQ(low.indoor.count(), 2400U);
    EXPECT_EQ(low.free.count(), 1800U);
    EXPECT_EQ(makeTarget(scene.environment, CellCount{60, 40}, 1.01).free.count(), 2400U);
}

}  // namespace coverage_test
}  // namespace ispace
