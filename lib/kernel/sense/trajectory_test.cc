// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "geom/rotation.h"

namespace ispace {

namespace trajectory_test {

constexpr Angle kLeft = Angle::degrees(90);

Pose3 pose(double heading, double tilt, double roll) {
    return {{1, 2, 3}, Angle::degrees(heading), Angle::degrees(tilt), Angle::degrees(roll)};
}

void expectNear(Vec3 a, Vec3 b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Trajectory, ATurnAboutTheVerticalIsExactlyLevel) {
    const auto line = parseTumLine("12.5 1 -2 0.15 0 0 0.7071067811865476 0.7071067811865476");
    ASSERT_TRUE(line);
    EXPECT_EQ(line->time, 12.5);
    EXPECT_EQ(line->pose.position, (Point3{1, -2, 0.15}));
    EXPECT_TRUE(line->pose.isLevel());
    EXPECT_NEAR(line->pose.heading.degrees(), 90, 1e-12);
    // Not of unit length, and with the other sign.
    EXPECT_NEAR(parseTumLine("0 0 0 0 0 0 -2 2")->pose.heading.degrees(), -90, 1e-12);
    EXPECT_EQ(parseTumLine("0 0 0 0 0 0 0 1e-200")->pose.heading, Angle());
    EXPECT_FALSE(parseTumLine("0 0 0 0 0 0.1 0 1")->pose.isLevel());
    EXPECT_LT(parseTumLine("0 0 0 0 0 0.1 0 1")->pose.tilt, Angle()) << "Ry(+) looks down";
}

TEST(Trajectory, SkipsCommentsAndBlankLines) {
    EXPECT_FALSE(parseTumLine(""));
    EXPECT_FALSE(parseTumLine(" \t\r"));
    EXPECT_FALSE(parseTumLine("# timestamp tx ty tz qx qy qz qw"));
    EXPECT_FALSE(parseTumLine("  #1 2 3"));
    EXPECT_TRUE(parseTumLine("\t1  2 3 4 0 0 0 1 \r"));
}

std::string messageOf(std::string_view line) {
    try {
        static_cast<void>(parseTumLine(line));
    } catch (const FormatError& error) {
        return error.diagnostics().front().message;
    }
    return "";
}

TEST(Trajectory, RefusesWhatIsNoPose) {
    EXPECT_EQ(messageOf("1 2 3"), "3 columns; a pose is `t x y z qx qy qz qw`");
    EXPECT_EQ(messageOf("1 2 3 4 0 0 0 1 9"),
              "more than 8 columns; a pose is `t x y z qx qy qz qw`");
    EXPECT_EQ(messageOf("1 2 3 4 0 0 0 0"), "the quaternion is 0, which is no rotation");
    EXPECT_EQ(messageOf("1 2 x 4 0 0 0 1"), "y `x` is not a number");
    EXPECT_EQ(messageOf("nan 2 3 4 0 0 0 1"), "t `nan` is not a number");
    EXPECT_EQ(messageOf("1 inf 3 4 0 0 0 1"), "x `inf` is not a number");
    EXPECT_EQ(messageOf("1 2 3 4 0 0 0 1e999"), "qw `1e999` is not a number");
    EXPECT_EQ(messageOf("1 2e7 3 4 0 0 0 1"), "the place is more than 1000 km away");
    EXPECT_EQ(messageOf("1e17 2 3 4 0 0 0 1"), "t is more than 285 years away");
}

TEST(Trajectory, BetweenIsStraightAndEven) {
    const Pose3 a{{0, 0, 0.15}, Angle::degrees(170), {}, {}};
    const Pose3 b{{1, 2, 0.15}, Angle::degrees(-170), {}, {}};
    const Pose3 middle = between(a, b, 0.25);
    EXPECT_TRUE(middle.isLevel());
    EXPECT_EQ(middle.position, (Point3{0.25, 0.5, 0.15}));
    EXPECT_NEAR(middle.heading.degrees(), 175, 1e-9) << "by the shortest way";
    EXPECT_EQ(between(a, a, 0.7), a);
    // At an even speed about any axis: thirds of the way are thirds of the angle.
    const Pose3 c = pose(20, 30, -40), d = pose(100, -20, 10);
    const auto apart = [](const Pose3& p, const Pose3& q) {
        return quaternionOf(p).angularDistance(quaternionOf(q));
    };
    EXPECT_NEAR(apart(c, between(c, d, 1.0 / 3)), apart(c, d) / 3, 1e-9);
    EXPECT_NEAR(apart(between(c, d, 1.0 / 3), d), 2 * apart(c, d) / 3, 1e-9);
    // The short way round where quaternions have opposite signs.
    expectNear(between(pose(170, 10, 0), pose(190, 10, 0), 0.5).beam({}), pose(180, 10, 0).beam({}),
               0.01);
    expectNear(between(pose(-170, 10, 5), pose(170, 10, 5), 0.5).beam({}),
               pose(180, 10, 5).beam({}), 0.01);
    expectNear(between(c, d, 0).beam({}), c.beam({}), 1e-12);
    expectNear(between(c, d, 1).beam({}), d.beam({}), 1e-12);
}

}  // namespace trajectory_test

}  // namespace ispace
