// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geom/point.h"

namespace ispace {
namespace pose_test {

TEST(Point, vectorsAndPlaces) {
    EXPECT_EQ((Point2{1, 2} + Vec2{3, 4}), (Point2{4, 6}));
    EXPECT_EQ((Point2{1, 2} - Point2{3, 5}), (Vec2{-2, -3}));
    EXPECT_EQ((Point2{1, 2} - Vec2{3, 5}), (Point2{-2, -3}));
    EXPECT_EQ(cross(Vec2{1, 0}, Vec2{0, 1}), 1);
    EXPECT_EQ(dot(Vec2{1, 2}, Vec2{3, 4}), 11);
    EXPECT_EQ(perpendicular({1, 2}), (Vec2{-2, 1}));
    EXPECT_EQ(unitVector(Angle::degrees(90)), (Vec2{0, 1}));
    EXPECT_EQ(distance(Point2{1, 1}, Point2{4, 5}), 5);
    EXPECT_EQ(length(Vec3{2, 3, 6}), 7);
    EXPECT_EQ((Point3{1, 2, 3} + 2 * Vec3{1, 0, 1}).onFloor(), (Point2{3, 2}));
}

TEST(Angle, cosSinIsThatOfTheExactRemainder) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> few(-800, 800), many(-3e6, 3e6);
    const auto expect = [](double degrees) {
        int quadrant = 0;
        const double rest = std::remquo(degrees, 90.0, &quadrant) * (std::numbers::pi / 180);
        const double c = std::cos(rest), s = std::sin(rest);
        const CosSin turned[] = {{c, s}, {-s, c}, {-c, -s}, {s, -c}};
        const auto [cos, sin] = cosSin(Angle::degrees(degrees));
        EXPECT_EQ(cos, turned[static_cast<unsigned>(quadrant) & 3U].cos) << degrees;
        EXPECT_EQ(sin, turned[static_cast<unsigned>(quadrant) & 3U].sin) << degrees;
    };
    for (int k = -100; k <= 100; ++k)
        for (const double way : {-1e9, 0.0, 1e9})
            expect(way == 0 ? 22.5 * k : std::nextafter(22.5 * k, way));
    for (int i = 0; i < 20000; ++i) {
        expect(few(random));
        expect(many(random));
    }
    EXPECT_EQ(cosSin(Angle::degrees(-0.0)).cos, 1);
}

TEST(Pose2, takesPointsToTheOuterFrame) {
    const Pose2 world_from_body{{3, 4}, Angle::degrees(90)};
    EXPECT_EQ((world_from_body * Point2{2, 0}), (Point2{3, 6}));
    EXPECT_EQ((world_from_body * Point2{0, 1}), (Point2{2, 4}));
    EXPECT_EQ((world_from_body * Vec2{2, 1}), (Vec2{-1, 2}));
}

TEST(Pose3, levelBeamIsExact) {
    const Pose3 pose{{0, 0, 1}, Angle::degrees(90), {}, {}};
    EXPECT_TRUE(pose.isLevel());
    EXPECT_EQ(pose.beam(Angle::degrees(0)), (Vec3{0, 1, 0}));
    EXPECT_EQ(pose.beam(Angle::degrees(90)), (Vec3{-1, 0, 0}));
    EXPECT_EQ(pose.beam(Angle::degrees(-90)), (Vec3{1, 0, 0}));
}

TEST(Pose3, positiveTiltLooksUpAndPositiveRollLiftsTheLeft) {
    const Pose3 up{{}, {}, Angle::degrees(90), {}};
    EXPECT_FALSE(up.isLevel());
    EXPECT_EQ(up.beam({}), (Vec3{0, 0, 1}));
    EXPECT_EQ(up.beam(Angle::degrees(90)), (Vec3{0, 1, 0}));
    const Pose3 rolled{{}, {}, {}, Angle::degrees(90)};
    EXPECT_FALSE(rolled.isLevel());
    EXPECT_EQ(rolled.beam(Angle::degrees(90)), (Vec3{0, 0, 1}));
    EXPECT_EQ(rolled.beam({}), (Vec3{1, 0, 0}));
}

/// Eq. 3.6 of the thesis as printed: x and z span its floor, y is up.
Vec3 thesisBeam(Angle m, Angle t, Angle d) {
    return {cos(m) * sin(d) + sin(m) * cos(t) * cos(d), sin(t) * cos(d),
            -sin(m) * sin(d) + cos(m) * cos(t) * cos(d)};
}

TEST(Pose3, beamFollowsTheFormulas) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> degrees(-180, 180);
    for (int i = 0; i < 1000; ++i) {
        const Angle m = Angle::degrees(degrees(random)), t = Angle::degrees(degrees(random));
        const Angle d = Angle::degrees(degrees(random));
        const Angle h = Angle::degrees(90) - m, b = -d;
        const Vec3 beam = Pose3{{}, h, t, {}}.beam(b);

        const Vec3 thesis = thesisBeam(m, t, d);
        EXPECT_NEAR(beam.x, thesis.x, 1e-14);
        EXPECT_NEAR(beam.y, thesis.z, 1e-14);
        EXPECT_NEAR(beam.z, thesis.y, 1e-14);

        const double x = cos(b) * cos(t), y = sin(b), z = cos(b) * sin(t);
        EXPECT_NEAR(beam.x, cos(h) * x - sin(h) * y, 1e-14);
        EXPECT_NEAR(beam.y, sin(h) * x + cos(h) * y, 1e-14);
        EXPECT_NEAR(beam.z, z, 1e-14);
    }
}

TEST(Pose3, rollTurnsAboutTheBeamAhead) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> degrees(-180, 180);
    for (int i = 0; i < 1000; ++i) {
        const Angle h = Angle::degrees(degrees(random)), t = Angle::degrees(degrees(random));
        const Angle r = Angle::degrees(degrees(random)), b = Angle::degrees(degrees(random));
        const Pose3 plain{{}, h, t, {}}, rolled{{}, h, t, r};
        // Bearings ±90 without roll are the y axis, and the third axis is x cross y.
        const Vec3 x = plain.beam({}), y = plain.beam(Angle::degrees(90));
        const Vec3 z{x.y * y.z - x.z * y.y, x.z * y.x - x.x * y.z, x.x * y.y - x.y * y.x};
        const Vec3 beam = rolled.beam(b);
        EXPECT_NEAR(dot(beam, x), cos(b), 1e-14);
        EXPECT_NEAR(dot(beam, y), sin(b) * cos(r), 1e-14);
        EXPECT_NEAR(dot(beam, z), sin(b) * sin(r), 1e-14);
    }
}

TEST(Angle, isExactAtQuarterTurns) {
    for (int turn = -8; turn <= 8; ++turn) {
        const Angle angle = Angle::degrees(90.0 * turn);
        const int quadrant = ((turn % 4) + 4) % 4;
        const double cosines[] = {1, 0, -1, 0}, sines[] = {0, 1, 0, -1};
        EXPECT_EQ(cos(angle), cosines[quadrant]) << turn;
        EXPECT_EQ(sin(angle), sines[quadrant]) << turn;
        EXPECT_FALSE(std::signbit(cos(angle)) && cos(angle) == 0) << turn;
        EXPECT_FALSE(std::signbit(sin(angle)) && sin(angle) == 0) << turn;
    }
    EXPECT_EQ(tan(Angle::degrees(180)), 0);
    EXPECT_NEAR(tan(Angle::degrees(45)), 1, 1e-15);
}

TEST(Angle, convertsUnits) {
    EXPECT_DOUBLE_EQ(Angle::degrees(180).radians(), std::numbers::pi);
    EXPECT_DOUBLE_EQ(Angle::radians(std::numbers::pi / 2).degrees(), 90);
    EXPECT_EQ((Angle::degrees(30) + 2.0 * Angle::degrees(15) - Angle::degrees(10)).degrees(), 50);
    EXPECT_EQ(-Angle::degrees(30), Angle::degrees(-30));
    EXPECT_LT(Angle::degrees(30), Angle::degrees(31));
}

TEST(Angle, agreesWithTheStandardLibrary) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> degrees(-1000, 1000);
    for (int i = 0; i < 1000; ++i) {
        const Angle angle = Angle::degrees(degrees(random));
        EXPECT_NEAR(cos(angle), std::cos(angle.radians()), 1e-13);
        EXPECT_NEAR(sin(angle), std::sin(angle.radians()), 1e-13);
    }
}

TEST(Angle, wrapsToHalfOpenTurn) {
    EXPECT_EQ(wrapped(Angle::degrees(180)).degrees(), 180);
    EXPECT_EQ(wrapped(Angle::degrees(-180)).degrees(), 180);
    EXPECT_EQ(wrapped(Angle::degrees(540)).degrees(), 180);
    EXPECT_EQ(wrapped(Angle::degrees(-190)).degrees(), 170);
    EXPECT_EQ(wrapped(Angle::degrees(360)).degrees(), 0);
    EXPECT_EQ(wrapped(Angle::degrees(359.5)).degrees(), -0.5);
}

TEST(Angle, directionOfVector) {
    EXPECT_EQ(directionOf(0, 0).degrees(), 0);
    EXPECT_EQ(directionOf(2, 0).degrees(), 0);
    EXPECT_DOUBLE_EQ(directionOf(0, 3).degrees(), 90);
    EXPECT_DOUBLE_EQ(directionOf(-1, 0).degrees(), 180);
    EXPECT_DOUBLE_EQ(directionOf(-1, -0.0).degrees(), 180);
    EXPECT_DOUBLE_EQ(directionOf(1, -1).degrees(), -45);
}

void expectNear(const Eigen::Vector3d& a, Vec3 b, double tolerance) {
    EXPECT_LE((a - vectorOf(b)).norm(), tolerance);
}

Pose3 pose(double heading, double tilt, double roll) {
    return {{1, 2, 3}, Angle::degrees(heading), Angle::degrees(tilt), Angle::degrees(roll)};
}

TEST(Rotation, TurnsAsPosesDo) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> any(-180, 180), tilts(-90, 90);
    for (int i = 0; i < 500; ++i) {
        Pose3 p = pose(any(random), tilts(random), any(random));
        if (i % 5 == 0) p.tilt = Angle::degrees(i % 2 == 0 ? 90 : -90);
        const Frame3 frame(p);
        const Eigen::Quaterniond q = quaternionOf(p);
        expectNear(q * Eigen::Vector3d::UnitX(), frame.forward, 1e-12);
        expectNear(q * Eigen::Vector3d::UnitY(), frame.left, 1e-12);
        expectNear(q * Eigen::Vector3d::UnitZ(), frame.up, 1e-12);
        const Pose3 back = poseOf(p.position, Eigen::Quaterniond(-3 * q.coeffs()));
        expectNear(vectorOf(back.beam({})), p.beam({}), 1e-7);
        expectNear(vectorOf(back.beam(Angle::degrees(90))), p.beam(Angle::degrees(90)), 1e-7);
        expectNear(isometryOf(p) * Eigen::Vector3d(0, 2, 0), p.position + 2 * frame.left - Point3(),
                   1e-12);
    }
}

TEST(Rotation, IsExactAtQuarterTurns) {
    for (int i = 0; i < 64; ++i) {
        const Frame3 frame(pose(90 * (i % 4), 90 * (i / 4 % 4), 90 * (i / 16)));
        for (const Vec3 axis : {frame.forward, frame.left, frame.up}) {
            EXPECT_EQ(dot(axis, axis), 1);
            for (const double part : {axis.x, axis.y, axis.z})
                EXPECT_TRUE(part == 0 || part == 1 || part == -1);
        }
    }
}

}  // namespace pose_test
}  // namespace ispace
