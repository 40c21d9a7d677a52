// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/mounting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "env/level.h"
#include "support/test_mixed_room.h"
#include "support/test_scenes.h"

namespace ispace::robustness {
namespace mounting_test {

using testing::kMixedRoom;

TEST(Mounting, ParsesTolerances) {
    EXPECT_NEAR(parseTolerance("5cm,3deg").distance, 0.05, 1e-15);
    EXPECT_NEAR(parseTolerance("0.1,3").angle.degrees(), 3, 1e-12);
    for (const char* text : {"", "5cm", "5cm,", ",3", "-1cm,3", "2,3", "1cm,181", "5cm,3,1"})
        EXPECT_ANY_THROW(parseTolerance(text)) << text;
}

TEST(Mounting, StaysWithinTolerances) {
    const Scene scene = sceneOf(kMixedRoom);
    const MountingTolerance tolerance{0.3, Angle::degrees(10)};
    double farthest = 0, widest = 0;
    for (std::uint64_t k = 0; k < 300; ++k)
        for (const Sensor& sensor : scene.sensors) {
            const Pose3 pose =
                mountedPose(scene.environment, sensor, tolerance, {.seed = 4, .frame = k});
            const double moved = distance(pose.position.onFloor(), sensor.pose.position.onFloor());
            const double turned = std::abs(wrapped(pose.heading - sensor.pose.heading).degrees());
            const double tilted = std::abs((pose.tilt - sensor.pose.tilt).degrees());
            EXPECT_LE(moved, 0.3 + 1e-9);
            EXPECT_LE(turned, 10 + 1e-9);
            EXPECT_LE(tilted, sensor.is<Camera>() ? 10 + 1e-9 : 0);
            EXPECT_TRUE(scene.environment.level(pose.position.z)->isFree(pose.position.onFloor()))
                << sensor.id;
            farthest = std::max(farthest, moved);
            widest = std::max(widest, turned);
        }
    EXPECT_GT(farthest, 0.28);
    EXPECT_GT(widest, 9.8);
}

TEST(Mounting, CrossesNoWall) {
    // The wall at x = -1 is nearer than the tolerance.
    const Scene scene = sceneOf(kMixedRoom + "laser id=near at=-0.95,-2 fov=180\n");
    for (std::uint64_t k = 0; k < 200; ++k)
        EXPECT_GT(mountedPose(scene.environment, scene.sensors.back(), {0.4, {}}, {.frame = k})
                      .position.x,
                  -1);
}

}  // namespace mounting_test
}  // namespace ispace::robustness
