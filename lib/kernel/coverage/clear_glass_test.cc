// SPDX-License-Identifier: GPL-3.0-or-later
// What sensors cover through a window: as much through clear glass as through an open hole, but for
// ultrasound.
#include <gtest/gtest.h>

#include <string>

#include "support/test_scenes.h"

namespace ispace {
namespace clear_glass_test {

/// A room whose middle wall has a large window.
CoverageReport reportOf(const std::string& glass, const std::string& sensor) {
    const std::string room =
        "ispace size=8,6,2.5\ninside at=-3,0\n"
        "wall id=w from=0,-2.9 to=0,2.9 height=2.5\n"
        "window wall=w offset=2.9 size=4,0.1,2 sill=0.1 glass=";
    return coverageOf(sceneOf(room + glass + '\n' + sensor + '\n')).report;
}

void expectThrough(const std::string& sensor) {
    const CoverageReport clear = reportOf("clear", sensor), open = reportOf("none", sensor);
    const CoverageReport opaque = reportOf("opaque", sensor);
    EXPECT_EQ(clear.total_effective_area.grid, open.total_effective_area.grid) << sensor;
    EXPECT_GT(*clear.total_effective_area.grid, *opaque.total_effective_area.grid + 1) << sensor;
    ASSERT_EQ(clear.sensors[0].area.exact.has_value(), open.sensors[0].area.exact.has_value());
    if (!clear.sensors[0].area.exact) return;
    EXPECT_NEAR(*clear.sensors[0].area.exact, *open.sensors[0].area.exact, 1e-9) << sensor;
    EXPECT_GT(*clear.sensors[0].area.exact, *opaque.sensors[0].area.exact + 1) << sensor;
}

TEST(ClearGlass, LasersAndRangersCoverWhatIsBehindIt) {
    for (const char* const sensor :
         {"laser at=-2,0.3,1 range=5", "laser at=-2,0.3,1 range=5 tilt=0.000001",
          "laser at=-2,0.3,1 range=5 tilt=-12", "laser at=-2,0.3,1 range=5 roll=20",
          "laser at=-2,0.3,1 range=5 tilt=-30 sweep=tilt sweep_span=60",
          "ranger at=-2,0,1.8 tilt=-30 fov=60,45 range=6",
          "ranger at=-2,0,1.8 projection=spherical fov=360,120 range=6"})
        expectThrough(sensor);
}

TEST(ClearGlass, LevelAndHardlyTiltedLasersCoverTheSame) {
    for (const char* const glass : {"clear", "opaque", "none"}) {
        const std::string laser = "laser at=-2,0.3,1 range=5";
        const CoverageReport level = reportOf(glass, laser);
        const CoverageReport tilted = reportOf(glass, laser + " tilt=0.000001");
        EXPECT_NEAR(*level.sensors[0].area.exact, *tilted.sensors[0].area.exact, 1e-4) << glass;
    }
}

TEST(ClearGlass, HidesTagsFromReceivers) {
    std::string receiver;
    for (const char* const y : {"-0.3", "-0.1", "0.1", "0.3"})
        receiver.append("ultrasound at=-1,").append(y).append(",2.3 tilt=-60 fov=120 range=8\n");
    const CoverageReport clear = reportOf("clear", receiver), open = reportOf("none", receiver);
    const CoverageReport opaque = reportOf("opaque", receiver);
    EXPECT_EQ(clear.total_effective_area.grid, opaque.total_effective_area.grid);
    EXPECT_GT(*open.total_effective_area.grid, *clear.total_effective_area.grid + 1);
    EXPECT_NEAR(*clear.sensors[0].area.exact, *opaque.sensors[0].area.exact, 1e-9);
    EXPECT_GT(*open.sensors[0].area.exact, *clear.sensors[0].area.exact + 1);
}

}  // namespace clear_glass_test
}  // namespace ispace
