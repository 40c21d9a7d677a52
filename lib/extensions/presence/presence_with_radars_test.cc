// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/presence/presence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "extensions/radars/radars_test.h"
#include "support/test_scenes.h"

namespace ispace::presence {
namespace presence_with_radars_test {

constexpr const char* kRoom = "ispace size=8,6\n";
constexpr double kStep = 0.1;  // s, between two moments
constexpr double kPlane = 1;   // m, the height of the sensors, too

/// A person on a straight path for so many seconds.
PeoplePaths straight(Point2 from, Vec2 velocity, double duration) {
    PathCutter cutter;
    for (int i = 0; i * kStep <= duration + 1e-9; ++i)
        cutter.add("p1", i * kStep, from + (i * kStep) * velocity);
    return cutter.finish();
}

Presence presenceIn(const std::string& sensors, const PeoplePaths& ways) {
    return measurePresence(sceneOf(kRoom + sensors), ways, kPlane);
}

constexpr const char* kRadar = "radar id=m1 at=-3,0,1 range=2 fov=60,60\n";

TEST(Presence, CountsTheWayInSightAndTheSecondBefore) {
    // It leaves the view at x = -1: the pieces that begin from -2 to -1 are detected.
    const Presence away = presenceIn(kRadar, straight({-2, 0}, {1, 0}, 5));
    EXPECT_NEAR(away.all.length, 5, 1e-9);
    EXPECT_NEAR(away.all.share, 1.2 / 5, 1e-9);
    EXPECT_NEAR(away.all.longest_gap, 3.8, 1e-9);
    // Likewise it enters the view there, after 4 s, and is detected in time from 3 s on.
    const Presence towards = presenceIn(kRadar, straight({3, 0}, {-1, 0}, 5.8));
    EXPECT_NEAR(towards.all.share, 2.8 / 5.8, 1e-9);
    EXPECT_NEAR(towards.people.at(0).longest_gap, 3, 1e-9);
}

TEST(Presence, IsAboutTheSpeedThatAKindDetects) {
    const PeoplePaths ways = straight({-2, 0}, {1, 0}, 1);
    EXPECT_EQ(presenceIn("radar at=-3,0,1 range=5 fov=60,60 min_speed=1.1\n", ways).all.share, 0);
    EXPECT_EQ(presenceIn("radar at=-3,0,1 range=5 fov=60,60 min_speed=0.9\n", ways).all.share, 1);
    // On a circle about it, chords of 0.2 rad have radial speeds of 0.1 m/s.
    PathCutter cutter;
    for (int i = 0; i <= 20; ++i)
        cutter.add("p1", i * kPathStep, {std::cos(0.2 * i), std::sin(0.2 * i)});
    const PeoplePaths circle = cutter.finish();
    EXPECT_EQ(presenceIn("radar at=0,0,1 fov=360,90 min_speed=0.15\n", circle).all.share, 0);
    EXPECT_EQ(presenceIn("radar at=0,0,1 fov=360,90 min_speed=0.05\n", circle).all.share, 1);
}

TEST(Presence, EndsAtWallsAndSolids) {
    const PeoplePaths ways = straight({1, 0}, {0.5, 0}, 2);
    EXPECT_EQ(presenceIn("radar at=-1,0,1\n", ways).all.share, 1);
    EXPECT_EQ(presenceIn("radar at=-1,0,1\nwall from=0,-3 to=0,3\n", ways).all.share, 0);
    EXPECT_EQ(presenceIn("radar at=-1,0,1\ncube at=-1,0 size=0.5,0.5,2\n", ways).all.share, 0);
    EXPECT_EQ(presenceIn("laser at=-1,0\n", ways).sensors.size(), 0U);
}

TEST(Presence, NamesThePartOfEachSensor) {
    const PeoplePaths ways = straight({-2, 0}, {1, 0}, 5);
    const Presence presence =
        presenceIn(std::string(kRadar) + "radar id=m2 at=-3,0,1 range=9 fov=60,60\n", ways);
    ASSERT_EQ(presence.sensors.size(), 2U);
    EXPECT_NEAR(presence.sensors[0].share, 1.2 / 5, 1e-9);
    EXPECT_EQ(presence.sensors[0].marginal, 0);
    EXPECT_NEAR(presence.sensors[1].share, 1, 1e-9);
    EXPECT_NEAR(presence.sensors[1].marginal, 3.8 / 5, 1e-9);
}

TEST(Presence, WithoutAWayIsNone) {
    const Presence presence = presenceIn(kRadar, {});
    EXPECT_EQ(presence.all.length, 0);
    EXPECT_EQ(presence.all.share, 0);
    EXPECT_TRUE(presence.people.empty());
}

}  // namespace presence_with_radars_test
}  // namespace ispace::presence
