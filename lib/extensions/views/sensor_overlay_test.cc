// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/views/sensor_overlay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/test_layout.h"

namespace ispace::views {
namespace sensor_overlay_test {

using testing::scene;

TEST(SensorOverlay, ViewCubesEndOnTheEdgesOfThePicture) {
    for (const char* lens : {"fov=60,45", "projection=fisheye fov=120", "coefficients=-0.2,0.05"}) {
        const Scene room = scene("ispace size=6,4 height=2.5\n",
                                 std::string("camera id=c at=-2.9,0,2 tilt=-30 ") + lens + "\n");
        const SensorOverlay marks = sightMarks(room, false, std::nullopt);
        ASSERT_EQ(marks.paint.size(), 1U) << lens;
        ASSERT_EQ(marks.lines.size(), 5U) << lens;  // four edges and the rim
        const Sensor& sensor = room.sensors.front();
        const auto& camera = sensor.as<Camera>();
        for (const Point3& place : marks.lines.back().places) {
            EXPECT_GE(place.z, -1e-4);
            EXPECT_LE(std::fabs(place.y), 2 + 1e-4);
            const auto pixel = camera.project(Frame3(sensor.pose).toLocal(place));
            ASSERT_TRUE(pixel) << lens;
            const double across = std::fabs(pixel->column - camera.cx) / (camera.columns / 2.0);
            const double down = std::fabs(pixel->row - camera.cy) / (camera.rows / 2.0);
            EXPECT_NEAR(std::max(across, down), 1, 1e-3) << lens;
        }
    }
}

TEST(SensorOverlay, ViewCubesAboutTheViewerAreLeftOut) {
    const Scene room = scene("ispace size=6,4 height=2.5\n", "camera at=-2.9,0,1 fov=60\n");
    EXPECT_TRUE(sightMarks(room, false, Point3{0, 0, 1}).paint.empty());
    EXPECT_FALSE(sightMarks(room, false, Point3{0, 1.9, 1}).paint.empty());
}

TEST(SensorOverlay, BeamsEndWhereTheLaserReads) {
    const Scene room =
        scene("ispace size=6,4 height=2.5\n", "laser at=0,0 range=8 fov=180 step=90\n");
    EXPECT_TRUE(sightMarks(room, false, std::nullopt).lines.empty());
    const SensorOverlay marks = sightMarks(room, true, std::nullopt);
    ASSERT_EQ(marks.lines.size(), 3U);
    EXPECT_NEAR(marks.lines[0].places[1].y, -2, 1e-6);
    EXPECT_NEAR(marks.lines[1].places[1].x, 3, 1e-6);
    EXPECT_NEAR(marks.lines[2].places[1].y, 2, 1e-6);
}

TEST(SensorOverlay, BeamsMeetLegsThatSwing) {
    // Ahead of the left leg.
    const Scene room = scene("ispace size=6,4\n",
                             "human at=0,0\nlaser at=-2,0.0935,0.15 range=8 fov=180 step=90\n");
    const auto reach = [&](std::span<const Angle> swings) {
        return sightMarks(room, true, std::nullopt, swings).lines[1].places[1].x;
    };
    const double radius = 0.035 * 1.7, hip = 0.48 * 1.7;
    const Angle swing = Angle::degrees(15);
    EXPECT_NEAR(reach({}), -radius, 1e-6);
    EXPECT_NEAR(reach({&swing, 1}), std::tan(swing.radians()) * (hip - 0.15) - radius, 1e-6);
}

TEST(FloorColors, AreThoseOfTheSensorsThatSeeAPlace) {
    const Scene room = scene("ispace size=6,4 height=2.5\n",
                             "laser at=-2,0 range=1.5\nlaser at=-1.5,0 range=1.5\n");
    const FloorColors colors(room);
    const Rgb none = colors.at({2, 1}), one = colors.at({-2, 0.5}), two = colors.at({-1, 0.2});
    EXPECT_EQ(none, (Rgb{1, 1, 1}));
    EXPECT_NE(one, none);
    EXPECT_NE(two, one);
    // Redder than blue, as the second is; never dark.
    EXPECT_GT(two[0] - one[0], two[2] - one[2]);
    for (const float part : two) EXPECT_GT(part, 0.1F);
    EXPECT_EQ(colors.at({99, 99}), none);
}

}  // namespace sensor_overlay_test
}  // namespace ispace::views
