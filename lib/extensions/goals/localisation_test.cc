// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/localisation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/test_scenes.h"

namespace ispace::goals {
namespace localisation_test {

Localisation localisedIn(const std::string& lines, double within = 1) {
    const Scene scene = sceneOf(lines);
    RayScenes worlds(scene.environment);
    return localise(scene, measureCoverage(scene, worlds, {.cells = CellSize{0.5}}), within);
}

/// Below 2.9 m, in a room of 8 by 6 m.
std::string earAt(int number, double x, double y) {
    return "ultrasound id=u" + std::to_string(number) + " at=" + std::to_string(x) + "," +
           std::to_string(y) + ",2.9 tilt=-90 fov=170 range=20 sigma=0.01\n";
}

TEST(Localisation, WithoutSensorsNoFloorHasAPosition) {
    const Localisation errors = localisedIn("ispace size=8,6,3\n", 0.5);
    EXPECT_EQ(errors.localised, 0);
    EXPECT_EQ(errors.share_within, 0);
    EXPECT_EQ(errors.mean, 0.5);
    EXPECT_FALSE(errors.median);
    EXPECT_FALSE(errors.most);
}

TEST(Localisation, OneLaserErrsByDistanceAndDirection) {
    // Without noise along its beams the error is that across them: the mean distance counts.
    const Localisation errors = localisedIn(
        "ispace size=8,6,3\nlaser id=l at=0.01,0.01 range=20 fov=360 step=0.01 sigma=0.001 "
        "angle_sigma=1\n");
    double sum = 0;
    int count = 0;
    for (double x = -3.75; x < 4; x += 0.5)
        for (double y = -2.75; y < 3; y += 0.5) {
            const double across = std::hypot(x - 0.01, y - 0.01) * Angle::degrees(1).radians();
            sum += std::hypot(0.001, across);
            ++count;
        }
    EXPECT_EQ(errors.localised, 1);
    EXPECT_NEAR(errors.mean.value(), sum / count, 1e-5);
    EXPECT_LT(errors.median.value(), errors.most.value());
}

TEST(Localisation, ATagNeedsFourReceivers) {
    std::string lines = "ispace size=8,6,3\n";
    for (int i = 0; i < 3; ++i) lines += earAt(i, 3 * i - 3, i - 1);
    EXPECT_EQ(localisedIn(lines).localised, 0);
    lines += earAt(3, -3, 2.5);
    const Localisation four = localisedIn(lines);
    EXPECT_EQ(four.localised, 1);
    EXPECT_LT(four.median.value(), 0.1);
    lines += earAt(4, 3, -2.5);
    EXPECT_LT(localisedIn(lines).mean.value(), four.mean.value());
}

TEST(Localisation, AFurtherSensorNeverRaisesAnError) {
    const std::string room =
        "ispace size=8,6,3\npillar id=p at=1,1 size=0.6,0.6,3\n"
        "laser id=l at=-3.9,0 range=6 fov=180 sigma=0.03 angle_sigma=0.5\n";
    const Localisation one = localisedIn(room);
    const Localisation two = localisedIn(
        room + "camera id=c at=3.9,2.9,2.8 heading=-140 tilt=-30 fov=80 pixels=640,480\n");
    for (std::size_t i = 0; i < one.errors.size(); ++i)
        EXPECT_LE(two.errors[i], one.errors[i]) << i;
    EXPECT_GT(two.share_within.value(), one.share_within.value());
}

}  // namespace localisation_test
}  // namespace ispace::goals
