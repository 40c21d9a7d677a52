// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/sensor/sensor.h"

namespace ispace {
namespace arc_path_test {

/// Where an arc of a radius leads, turning by an angle.
Pose2 onArc(const Pose2& from, double radius, Angle turn) {
    const Angle heading = from.heading + turn;
    return {from.position +
                radius * Vec2{sin(heading) - sin(from.heading), cos(from.heading) - cos(heading)},
            heading};
}

TEST(ArcPath, IsAnArcOfAnyTurn) {
    const Pose2 from{{1, 2}, Angle::degrees(30)};
    for (const double degrees : {0.5, 9.0, 45.0, 90.0, 135.0, 179.0, -1.0, -60.0, -179.0}) {
        const Angle turn = Angle::degrees(degrees);
        const ArcPath way(from, onArc(from, 0.5, turn));
        for (double share = 0; share <= 1; share += 0.125) {
            const Pose2 found = way.at(share), exact = onArc(from, 0.5, share * turn);
            EXPECT_NEAR(found.position.x, exact.position.x, 1e-14) << degrees << ' ' << share;
            EXPECT_NEAR(found.position.y, exact.position.y, 1e-14) << degrees << ' ' << share;
            EXPECT_NEAR(wrapped(found.heading - exact.heading).degrees(), 0, 1e-12);
        }
    }
}

TEST(ArcPath, EndsExactly) {
    const Pose2 from{{0.1, 0.2}, Angle::degrees(10)}, to{{0.7, -0.3}, Angle::degrees(-55.5)};
    EXPECT_EQ(ArcPath(from, to).at(0), from);
    EXPECT_EQ(ArcPath(from, to).at(1), to);
}

TEST(ArcPath, StraightOnAndOnTheSpot) {
    const Pose2 from{{1, 2}, Angle::degrees(90)};
    EXPECT_EQ(ArcPath(from, {{1, 3}, Angle::degrees(90)}).at(0.25),
              (Pose2{{1, 2.25}, Angle::degrees(90)}));
    EXPECT_EQ(ArcPath(from, {{1, 2}, Angle::degrees(100)}).at(0.5),
              (Pose2{{1, 2}, Angle::degrees(95)}));
    // By the shorter way.
    EXPECT_EQ(ArcPath({{}, Angle::degrees(170)}, {{}, Angle::degrees(-170)}).at(0.25).heading,
              Angle::degrees(175));
}

TEST(ArcPath, CarriesWhatIsMounted) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-5, 5), angle(-180, 180), part(0, 1);
    for (int round = 0; round < 200; ++round) {
        const Pose2 from{{place(random), place(random)}, Angle::degrees(angle(random))};
        const Pose2 to{{place(random), place(random)}, Angle::degrees(angle(random))};
        const Pose2 mount{{place(random), place(random)}, Angle::degrees(angle(random))};
        const double first = part(random), step = (part(random) - first) / 10;
        BeamFrames frames;
        frames.resize(12);
        const ArcPath way(from, to);
        way.carry(mount, first, step, 1, 11, frames);
        EXPECT_EQ(frames.x[0], 0);
        EXPECT_EQ(frames.x[11], 0);
        for (std::size_t k = 1; k < 11; ++k) {
            const Pose3 exact =
                mountedPose(way.at(first + static_cast<double>(k - 1) * step),
                            {{mount.position.x, mount.position.y, 0.3}, mount.heading, {}, {}});
            EXPECT_NEAR(frames.x[k], exact.position.x, 1e-13);
            EXPECT_NEAR(frames.y[k], exact.position.y, 1e-13);
            EXPECT_NEAR(frames.cos[k], cos(exact.heading), 1e-14);
            EXPECT_NEAR(frames.sin[k], sin(exact.heading), 1e-14);
        }
    }
}

TEST(ArcPath, FacesExactlyWhereItGoesStraightOn) {
    BeamFrames frames;
    frames.resize(3);
    const Pose2 from{{1, 2}, Angle::degrees(90)};
    ArcPath(from, {{1, 3}, Angle::degrees(90)}).carry({{0.5, 0}, {}}, 0, 0.5, 0, 3, frames);
    EXPECT_EQ(frames.cos, std::vector<double>(3, 0.0));
    EXPECT_EQ(frames.sin, std::vector<double>(3, 1.0));
    EXPECT_EQ(frames.x, std::vector<double>(3, 1.0));
    EXPECT_EQ(frames.y, (std::vector<double>{2.5, 3, 3.5}));
}

}  // namespace arc_path_test
}  // namespace ispace
