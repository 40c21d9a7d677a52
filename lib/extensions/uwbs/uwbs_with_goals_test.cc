// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "extensions/goals/localisation.h"
#include "extensions/uwbs/uwbs_test.h"
#include "support/test_scenes.h"

namespace ispace::uwbs {
namespace uwbs_with_goals_test {

using goals::Localisation;

Localisation localisedIn(const std::string& lines) {
    const Scene scene = sceneOf(lines);
    RayScenes worlds(scene.environment);
    return goals::localise(scene, measureCoverage(scene, worlds, {.cells = CellSize{0.5}}), 1);
}

/// An anchor that errs by 3 cm, below 2.9 m in a room of 8 by 6 m.
std::string anchorAt(double x, double y) {
    return "uwb at=" + std::to_string(x) + "," + std::to_string(y) +
           ",2.9 tilt=-90 range=20 sigma=0.03\n";
}

TEST(Uwb, LocatesATagByThreeAnchors) {
    std::string lines = "ispace size=8,6,3\n" + anchorAt(-3.9, -2.9) + anchorAt(3.9, -2.9);
    EXPECT_EQ(localisedIn(lines).localised, 0) << "a mirror image is as good";
    lines += anchorAt(-3.9, 2.9);
    EXPECT_EQ(localisedIn(lines).localised, 1);
    // Where a laser sees the tag, too, two anchors still do not count.
    const std::string laser =
        "ispace size=8,6,3\nlaser at=0.01,0.01 range=20 fov=360 sigma=0.01 angle_sigma=1\n";
    EXPECT_EQ(localisedIn(laser + anchorAt(-3.9, -2.9) + anchorAt(3.9, -2.9)).mean,
              localisedIn(laser).mean);
}

}  // namespace uwbs_with_goals_test
}  // namespace ispace::uwbs
