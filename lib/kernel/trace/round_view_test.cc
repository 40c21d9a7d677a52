// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/round_view.h"

#include <gtest/gtest.h>

#include <random>

namespace ispace {

namespace round_view_test {

constexpr double kTouching = 1e-4;

class RoundViews : public ::testing::Test {
  protected:
    double any(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    RoundBody anyBody() {
        const double length = any(0.02, 2);
        const double width = any(0, 1) < 0.5 ? length : any(0.02, 2);
        const double bottom = any(-0.5, 0.5);
        return {Ellipse({any(-1, 1), any(-1, 1)}, length, width, Angle::degrees(any(-180, 180))),
                bottom, bottom + any(0.01, 2)};
    }
    /// Rays from an origin to somewhere about the body.
    RayPacket aimedAt(const RoundBody& body, Point3 origin) {
        RayPacket packet{};
        packet.origin_x.fill(origin.x);
        packet.origin_y.fill(origin.y);
        packet.origin_z.fill(origin.z);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const Vec2 aside = body.curve.fromUnit({any(-1.2, 1.2), any(-1.2, 1.2)});
            const Point2 place = body.curve.center + aside;
            packet.x[lane] = place.x - origin.x;
            packet.y[lane] = place.y - origin.y;
            packet.z[lane] = any(body.bottom - 0.2, body.top + 0.2) - origin.z;
            packet.reach[lane] = any(0.5, 3);
        }
        return packet;
    }

    std::mt19937_64 random_{7};
};

TEST_F(RoundViews, PacketsMeetWhatSingleRaysMeet) {
    int met = 0, passed = 0;
    for (int round = 0; round < 2000; ++round) {
        const RoundBody body = anyBody();
        const Point3 origin{any(-3, 3), any(-3, 3), any(-1, 3)};
        const RoundView view(body, origin, kTouching);
        const RayPacket packet = aimedAt(body, origin);
        std::array<float, kLanes> multiples{};
        if (!view.meet(packet, multiples)) {
            // It is in the body or touches it.
            EXPECT_LT(body.curve.heightOf(origin.onFloor()), 2 * kTouching);
            continue;
        }
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const RayHit hit = meetRound(body, packet.ray(lane), kTouching);
            ASSERT_EQ(multiples[lane], static_cast<float>(hit.multiple)) << round << ' ' << lane;
            ++(hit.isNone() ? passed : met);
        }
    }
    EXPECT_GT(met, 5000);
    EXPECT_GT(passed, 5000);
}

TEST_F(RoundViews, UprightAndLevelRaysNeedACloserLook) {
    const RoundBody body{Ellipse({0, 0}, 1, 1, Angle()), 0, 1};
    const Point3 origin{0.1, 0, 3};
    const RoundView view(body, origin, kTouching);
    std::array<float, kLanes> multiples{};
    RayPacket packet = aimedAt(body, origin);
    EXPECT_TRUE(view.meet(packet, multiples));
    packet.x[3] = packet.y[3] = 0;
    EXPECT_FALSE(view.meet(packet, multiples));
    packet = aimedAt(body, origin);
    packet.z[15] = 0;
    EXPECT_FALSE(view.meet(packet, multiples));
}

TEST_F(RoundViews, NoneIsHadFromNearTheSurfaceOrWithin) {
    const RoundBody body{Ellipse({0, 0}, 2, 1, Angle()), 0, 1};
    std::array<float, kLanes> multiples{};
    const auto is_had = [&](Point3 origin) {
        return RoundView(body, origin, kTouching).meet(aimedAt(body, origin), multiples);
    };
    EXPECT_FALSE(is_had({0, 0, 0.5}));
    EXPECT_FALSE(is_had({1 + 0.9 * kTouching, 0, 0.5}));
    EXPECT_FALSE(is_had({0, 0.5 + 0.9 * kTouching, 0.5}));
    EXPECT_FALSE(is_had({0.2, 0.2, 1 + 0.9 * kTouching}));
    EXPECT_TRUE(is_had({1.1, 0, 0.5}));
    EXPECT_TRUE(is_had({0.2, 0.2, 1.1}));
    EXPECT_TRUE(is_had({0.2, 0.2, -0.1}));
}

}  // namespace round_view_test

}  // namespace ispace
