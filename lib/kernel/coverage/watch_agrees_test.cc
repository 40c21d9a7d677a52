// SPDX-License-Identifier: GPL-3.0-or-later
// Detection in a run agrees with coverage, which DetectionMonitor is compared with point by point.
#include <gtest/gtest.h>

#include "sense/detection.h"
#include "support/test_scenes.h"

namespace ispace {
namespace watch_agrees_test {

TEST(WatchAgrees, WithTheCellsOfCoverage) {
    const Scene scene = sceneOf(
        "ispace size=8,6,2.5\n"
        "table at=1,1 size=0.8,0.8,0.8\npillar at=-1,0.5 size=0.4,0.4,2.5\n"
        "desk at=-2,-1 heading=20 size=1.2,0.6,0.7\n"
        "laser id=a at=-3.9,0 heading=5 range=6 fov=170\n"
        "laser id=b at=3,2.5,0.4 heading=-135 tilt=-8 range=6 fov=120\n"
        "laser id=c at=0,-2.8,1 heading=60 range=5 fov=10 tilt=-60 sweep=tilt sweep_span=60 "
        "sweep_step=2\n"
        "laser id=d at=2,-2 heading=0 range=2 fov=45 sweep=heading sweep_span=120 sweep_step=3\n"
        "ranger id=e at=-3.9,2.9,2 heading=-40 tilt=-35\n"
        "camera id=f at=3.9,-2.9,2.2 heading=140 tilt=-30 pixels=640,480 fov=70 range=9\n"
        "ultrasound at=1,1,2.4 tilt=-90\nultrasound at=-1,1,2.4 tilt=-90\n"
        "ultrasound at=1,-1,2.4 tilt=-90\nultrasound at=-1,-1,2.4 tilt=-90\n");
    const Coverage coverage = coverageOf(scene, 64, 48);
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    const DetectionMonitor watch(scene);
    EXPECT_EQ(watch.sensors(), coverage.sets.size());
    std::size_t compared = 0, different = 0, seen = 0;
    for (std::size_t cell = 0; cell < times.size(); ++cell) {
        if (!coverage.target.free.test(cell)) continue;
        ++compared;
        seen += times[cell] > 0 ? 1 : 0;
        if (watch.seenBy({coverage.report.grid.center(cell)}) != times[cell]) ++different;
    }
    EXPECT_GT(seen, compared / 2);
    // Points exactly on an edge may be decided either way.
    EXPECT_LE(different, compared / 500) << compared;
}

}  // namespace watch_agrees_test
}  // namespace ispace
