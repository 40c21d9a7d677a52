// SPDX-License-Identifier: GPL-3.0-or-later
// Anchors among the sensors of a layout: information about positions, and equal views.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "coverage/visible_area.h"
#include "extensions/uwbs/uwbs_test.h"
#include "sense/dilution.h"
#include "support/test_scenes.h"

namespace ispace::uwbs {
namespace uwb_views_test {

TEST(Uwb, MeasuresDistances) {
    // At right angles in the plane of the tag, each distance is a coordinate.
    Uwb anchor;
    anchor.noise.sigma[0] = 0.03;
    SpaceInformation sum = informationOf(modelOf(anchor), {4, 0, 1}, {0, 0, 1});
    EXPECT_TRUE(std::isinf(atKnownHeight(sum).error())) << "one distance is a circle";
    sum += informationOf(modelOf(anchor), {0, 3, 1}, {0, 0, 1});
    EXPECT_NEAR(atKnownHeight(sum).error(), 0.03 * std::sqrt(2.0), 1e-12);
}

TEST(Uwb, SeesTheSameAmongOtherAnchorsAndTags) {
    const std::string first = "ispace size=8,6\nuwb id=u1 at=-3,0,2 range=4\n";
    const auto anchor_in = [](const std::string& lines) { return sceneOf(lines).sensors.front(); };
    const Sensor alone = anchor_in(first);
    const Sensor among = anchor_in(first + "uwb id=u2 at=0,2,2\ncube at=1,1 tag=t\n");
    EXPECT_NE(alone.model, among.model);
    EXPECT_TRUE(seeAlike(alone, among));
    EXPECT_FALSE(seeAlike(alone, anchor_in("ispace size=8,6\nuwb at=-3,0,2 range=5\n")));
    EXPECT_FALSE(seeAlike(alone, anchor_in("ispace size=8,6\nuwb at=-3,1,2 range=4\n")));
    EXPECT_FALSE(seeAlike(alone, anchor_in("ispace size=8,6\nranger at=-3,0,2\n")));
}

}  // namespace uwb_views_test
}  // namespace ispace::uwbs
