// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/rotation.h"

#include <gtest/gtest.h>

#include <random>

namespace ispace {

namespace {

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

}  // namespace

}  // namespace ispace
