// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/fan_arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cover/test_sensors.h"
#include "cover/visible.h"

namespace ispace {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// What coverage says of a cell in this direction.
bool seesCell(const Laser& laser, Angle heading, double direction) {
    const VisibleCells visible{{{0, 0.5F, direction}}};
    return !cellsInFan(Grid{Box2{{0, 0}, {1, 1}}, 1, 1}, visible, laser, heading).empty();
}

bool holds(const FanArc& arc, double direction) {
    const Angle at = Angle::degrees(direction);
    if (arc.first < arc.beyond) return arc.first <= at && at < arc.beyond;
    return arc.first <= at || at < arc.beyond;
}

/// The double after it counter-clockwise, or before it.
double neighbour(double direction, bool after) {
    const double next = std::nextafter(direction, after ? 1000 : -1000);
    if (next > 180) return std::nextafter(-180.0, 0);
    return next <= -180 ? 180 : next;
}

/// Directions about the sides of a fan: doubles next to each other, and others a hair apart.
void expectSharp(const Laser& laser, Angle heading, const FanArc& arc, Random& random) {
    for (const double side : {arc.first.degrees(), arc.beyond.degrees()}) {
        ASSERT_EQ(wrapped(Angle::degrees(side)), Angle::degrees(side));
        for (const bool after : {false, true}) {
            double direction = side;
            for (int i = 0; i < 20; ++i, direction = neighbour(direction, after))
                ASSERT_EQ(seesCell(laser, heading, direction), holds(arc, direction))
                    << heading.degrees() << ' ' << direction;
        }
        for (int i = 0; i < 20; ++i) {
            const double by = std::pow(10, uniform(random, -16, 1)) * (i % 2 == 0 ? 1 : -1);
            const double direction = wrapped(Angle::degrees(side + by)).degrees();
            ASSERT_EQ(seesCell(laser, heading, direction), holds(arc, direction))
                << heading.degrees() << ' ' << direction;
        }
    }
}

/// Of its two sides alone.
Laser fanOf(double first, double span) {
    Laser laser = laserWith(4, first, 1);
    laser.step = Angle::degrees(span);
    return laser;
}

Laser randomLaser(Random& random) {
    const double fov =
        random() % 3 == 0 ? uniform(random, 0, 359.9) : static_cast<double>(random() % 8 * 45);
    Laser laser = fanOf(random() % 2 == 0 ? -fov / 2 : uniform(random, -180, 180), fov);
    if (random() % 4 == 0) {
        laser.sweep = SweepAxis::Heading;
        laser.sweep_span = Angle::degrees(30);
    }
    return laser;
}

TEST(FanArc, IsWhereCellsAreSeenToTheBit) {
    Random random(40);
    int arcs = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const Laser laser = randomLaser(random);
        double degrees = 22.5 * static_cast<double>(random() % 64) - 720;
        if (trial % 3 == 0) degrees += 1e-10 * static_cast<double>(random() % 40);
        if (trial % 3 == 1) degrees = uniform(random, -1000, 1000);
        if (trial % 5 == 0) degrees -= laser.first.degrees();  // a side at 0, 180 or so
        const Angle heading = Angle::degrees(degrees);
        const std::optional<FanArc> arc = fanArc(laser, heading);
        if (!arc) continue;
        ++arcs;
        ASSERT_NO_FATAL_FAILURE(expectSharp(laser, heading, *arc, random)) << trial;
    }
    EXPECT_GT(arcs, 1700);
}

TEST(FanArc, SidesThatMeetButForRoundings) {
    const Laser third = laserWith(4, -60, 120);
    const FanArc one = fanArc(third, Angle()).value(),
                 two = fanArc(third, Angle::degrees(120)).value();
    EXPECT_NEAR(one.first.degrees(), -60 - 1e-9, 1e-13);
    EXPECT_NEAR(one.beyond.degrees(), 60 + 1e-9, 1e-13);
    EXPECT_NEAR(two.first.degrees(), 60 - 1e-9, 1e-13);
    // All these look to 90 degrees, and are told apart.
    const Laser half = laserWith(4, -90, 180);
    const FanArc still = fanArc(half, Angle()).value();
    EXPECT_EQ(fanArc(half, Angle::degrees(0)), still);
    EXPECT_GT(fanArc(half, Angle::degrees(1e-10)).value().beyond, still.beyond);
    EXPECT_LT(fanArc(half, Angle::degrees(-1e-10)).value().beyond, still.beyond);
}

TEST(FanArc, NoneOfWholeTurnsAndWhereItIsTorn) {
    for (const double span : {360.0, 360 - 1e-10}) {
        const Laser laser = fanOf(-180, span);
        EXPECT_TRUE(laser.seesAround());
        EXPECT_FALSE(fanArc(laser, Angle()).has_value());
    }
    EXPECT_FALSE(fanOf(-180, 360 - 1e-8).seesAround());
    EXPECT_TRUE(fanArc(fanOf(-180, 360 - 1e-8), Angle()).has_value());
    // Too narrow a gap to look for its sides, and too large an angle.
    EXPECT_FALSE(fanOf(-180, 360 - 1.5e-9).seesAround());
    EXPECT_FALSE(fanArc(fanOf(-180, 360 - 1.5e-9), Angle()).has_value());
    EXPECT_FALSE(fanArc(laserWith(4, -90, 180), Angle::degrees(1e7)).has_value());
    // Its end is at 180 degrees, where differences round in another way than at -180.
    const Laser torn = fanOf(-101.20355280257412, 109.30368948395606);
    const Angle heading = Angle::degrees(171.89986331761804);
    EXPECT_FALSE(fanArc(torn, heading).has_value());
    EXPECT_FALSE(seesCell(torn, heading, 180));
    EXPECT_TRUE(seesCell(torn, heading, std::nextafter(-180.0, 0)));
}

}  // namespace
}  // namespace ispace
