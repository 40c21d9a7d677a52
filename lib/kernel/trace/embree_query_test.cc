// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace ispace {

namespace embree_query_test {

constexpr float kMaxReach = 8;

/// Rays from one origin towards a plane, and what Embree might say of them.
struct Case {
    std::array<Plane, 2> planes{};
    std::array<double, 2> margins{};
    alignas(64) RTCRayHit16 hits{};
    RayPacket packet{};
    SureMeeting sure{.clear = 1e-5,
                     .longest = 1 + kFloatTolerance,
                     .near = static_cast<float>(kMaxReach * (1 - kFloatTolerance))};

    explicit Case(std::mt19937_64& random) {
        std::uniform_real_distribution<double> any(-1, 1);
        for (Plane& plane : planes) {
            const Vec3 way{any(random), any(random), any(random)};
            plane = {(1 / length(way)) * way, 3 * any(random)};
        }
        margins = {1e-3, 1e-3};
        packet.origin_x.fill(any(random));
        packet.origin_y.fill(any(random));
        packet.origin_z.fill(any(random));
        packet.reach.fill(static_cast<double>(kMaxReach) * (1 + kFloatTolerance));
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const Vec3 way{any(random), any(random), any(random)};
            const Vec3 direction = (1 / length(way)) * way;
            packet.x[lane] = direction.x;
            packet.y[lane] = direction.y;
            packet.z[lane] = direction.z;
            hits.hit.u[lane] = 0.3F;
            hits.hit.v[lane] = 0.3F;
        }
    }
    [[nodiscard]] bool meetOne() {
        return meetOnePlane(hits, planes.data(), margins.data(), sure, packet);
    }
    /// \return the lanes that need a closer look
    std::uint32_t meetAll() {
        return meetPlanes(hits, planes.data(), margins.data(), sure.clear, kMaxReach, packet);
    }
};

TEST(MeetOnePlane, SaysWhatMeetPlanesSays) {
    std::mt19937_64 random(11);
    int sure = 0;
    for (int round = 0; round < 20000; ++round) {
        Case test(random);
        Case other = test;
        const std::uint32_t care = other.meetAll();
        if (!test.meetOne()) continue;
        ++sure;
        EXPECT_EQ(care, 0U);
        EXPECT_EQ(test.packet.multiples, other.packet.multiples);
        EXPECT_EQ(test.packet.slopes, other.packet.slopes);
    }
    EXPECT_GT(sure, 100);
}

/// Rays that go straight at a wall 2 m away.
Case straight() {
    std::mt19937_64 random(1);
    Case test(random);
    test.planes[0] = {{1, 0, 0}, 2};
    test.planes[1] = {{1, 0, 0}, 2.5};
    test.packet.origin_x.fill(0);
    test.packet.x.fill(1);
    test.packet.y.fill(0);
    test.packet.z.fill(0);
    return test;
}

TEST(MeetOnePlane, HitsInTheMiddleOfATriangleAreSure) {
    Case test = straight();
    ASSERT_TRUE(test.meetOne());
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        EXPECT_EQ(test.packet.multiples[lane], 2);
        EXPECT_EQ(test.packet.slopes[lane], 1);
    }
}

TEST(MeetOnePlane, NothingIsSureToo) {
    Case test = straight();
    std::fill_n(test.hits.hit.geomID, kLanes, RTC_INVALID_GEOMETRY_ID);
    ASSERT_TRUE(test.meetOne());
    EXPECT_EQ(test.packet.multiples[5], kNoReturn);
    EXPECT_EQ(test.packet.slopes[5], kNoReturn);
}

TEST(MeetOnePlane, LeavesDoubtsToOthers) {
    const auto is_sure_with = [](auto change) {
        Case test = straight();
        test.packet.multiples.fill(-1);
        change(test);
        const bool is_sure = test.meetOne();
        EXPECT_TRUE(is_sure || test.packet.multiples[0] == -1);
        return is_sure;
    };
    EXPECT_TRUE(is_sure_with([](Case&) {}));
    EXPECT_FALSE(is_sure_with([](Case& t) { t.hits.hit.primID[7] = 1; }));
    EXPECT_FALSE(is_sure_with([](Case& t) { t.hits.hit.geomID[7] = RTC_INVALID_GEOMETRY_ID; }));
    EXPECT_FALSE(is_sure_with([](Case& t) { t.hits.hit.geomID[0] = RTC_INVALID_GEOMETRY_ID; }));
    EXPECT_FALSE(is_sure_with([](Case& t) { t.hits.hit.u[15] = 1e-3F; }));
    EXPECT_FALSE(is_sure_with([](Case& t) { t.hits.hit.v[2] = -1e-3F; }));
    EXPECT_FALSE(is_sure_with([](Case& t) { t.hits.hit.v[2] = 0.7F; }));
    EXPECT_FALSE(is_sure_with([](Case& t) { t.planes[0].offset = 1e-6; }));
    EXPECT_FALSE(is_sure_with([](Case& t) { t.planes[0].offset = 8; }));
    EXPECT_FALSE(
        is_sure_with([](Case& t) { t.margins[0] = std::numeric_limits<double>::infinity(); }));
    EXPECT_FALSE(
        is_sure_with([](Case& t) { t.packet.x[4] = std::numeric_limits<double>::quiet_NaN(); }));
}

}  // namespace embree_query_test

}  // namespace ispace
