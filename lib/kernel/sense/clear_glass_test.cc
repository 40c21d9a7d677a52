// SPDX-License-Identifier: GPL-3.0-or-later
// Light passes clear glass at any tilt, sound does not.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/test_readings.h"

namespace ispace {

namespace clear_glass_test {

/// A room of 8 m by 6 m with a wall at x = 1 that ends before those of the room, and in it a window
/// 3 m wide from 0.5 m to 2 m.
std::string room(const std::string& glass) {
    return "ispace size=8,6,2.5\ninside at=-3,0\n"
           "wall id=w from=1,-2.9 to=1,2.9 height=2.5\n"
           "window wall=w offset=2.9 size=3,0.1,1.5 sill=0.5 glass=" +
           glass + "\n";
}

Scan scanOf(const std::string& glass, const std::string& laser) {
    return testing::scans(testing::scene(room(glass), "laser at=-3,0.3,1 range=30 " + laser + "\n"))
        .front();
}

TEST(ClearGlass, LevelAndHardlyTiltedBeamsAgree) {
    for (const char* const glass : {"clear", "opaque", "none"}) {
        const Scan level = scanOf(glass, "fov=170 step=0.5");
        EXPECT_NEAR(level.ranges[170], glass == std::string("opaque") ? 4 : 7, 1e-6) << glass;
        for (const char* const lean : {"tilt=0.000001", "tilt=-0.000001", "roll=0.000001"}) {
            const Scan tilted = scanOf(glass, std::string("fov=170 step=0.5 ") + lean);
            ASSERT_EQ(tilted.ranges.size(), level.ranges.size());
            for (std::size_t k = 0; k < level.ranges.size(); ++k)
                EXPECT_NEAR(tilted.ranges[k], level.ranges[k], 1e-4)
                    << glass << ' ' << lean << ' ' << k;
        }
    }
}

TEST(ClearGlass, TiltedBeamsPassThePaneAndNothingElse) {
    const auto ahead = [](double tilt) {
        return scanOf("clear", "beams=1 first=0 tilt=" + std::to_string(tilt)).ranges.front();
    };
    const auto slope = [](double tilt) { return std::cos(Angle::degrees(tilt).radians()); };
    EXPECT_NEAR(ahead(-7), 7 / slope(-7), 1e-5) << "down through the pane";
    EXPECT_NEAR(ahead(-8), 4 / slope(-8), 1e-5) << "the wall below the sill";
    EXPECT_NEAR(ahead(12), 7 / slope(12), 1e-5) << "up through the pane";
    EXPECT_NEAR(ahead(15), 4 / slope(15), 1e-5) << "the wall above it";
}

TEST(ClearGlass, ASweepIsTheSameThroughout) {
    // The middle of its scans is level.
    const auto scans = testing::scans(testing::scene(
        room("clear"),
        "laser at=-3,0,1 range=30 fov=40 step=1 tilt=-3 sweep=tilt sweep_span=6 sweep_step=0.5\n"));
    ASSERT_EQ(scans.size(), 13U);
    EXPECT_TRUE(scans[6].pose.isLevel());
    for (const Scan& scan : scans)
        EXPECT_NEAR(scan.ranges[20] * cos(scan.pose.tilt), 7, 1e-4) << scan.pose.tilt.degrees();
}

TEST(ClearGlass, RangersLookThroughIt) {
    const auto middle = [](const std::string& glass) {
        const Scene scene = testing::scene(
            room(glass), "ranger at=-3,0,1 range=30 measures=depth pixels=9,7 fov=20 tilt=-1\n");
        return std::get<DepthFrame>(testing::readings(scene).at(0)).depths.at(3 * 9 + 4);
    };
    const double slope = std::cos(Angle::degrees(1).radians());
    EXPECT_NEAR(middle("clear"), 7 / slope, 1e-5);
    EXPECT_NEAR(middle("none"), 7 / slope, 1e-5);
    EXPECT_NEAR(middle("opaque"), 4 / slope, 1e-5);
}

TEST(ClearGlass, StopsUltrasound) {
    const auto heard = [](const std::string& glass) {
        // A ranger in the same scene sees through what the tag is not heard through.
        const Scene scene = testing::scene(room(glass),
                                           "ranger at=-3,0,1 range=30 pixels=1,1\n"
                                           "tag at=-1,0,1.2\n"
                                           "ultrasound at=2.5,0,1.3 heading=180 fov=120 range=8\n"
                                           "ultrasound at=-2.5,0,1.3 fov=120 range=8\n");
        const auto readings = testing::readings(scene);
        EXPECT_NEAR(std::get<DepthFrame>(readings.at(0)).depths.at(0), 7, 1e-5);
        return std::get<Burst>(readings.at(1)).heard.size();
    };
    EXPECT_EQ(heard("clear"), 1U);
    EXPECT_EQ(heard("none"), 2U);
}

}  // namespace clear_glass_test

}  // namespace ispace
