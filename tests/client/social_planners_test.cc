// SPDX-License-Identifier: GPL-3.0-or-later
// The baselines of share/benchmarks/social: half-planes of ORCA against sampled velocities, and
// what the planners do before a wall and a person.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "orca.h"
#include "planners.h"

namespace social {
namespace {

Body robotBody() {
    Body body;
    body.radius = 0.25;
    body.speed = 1;
    body.turn = kPi / 2;
    body.accel = 1;
    body.turn_accel = 2 * kPi;
    return body;
}

/// At the origin, towards +x, at full speed.
View viewAhead() {
    View view;
    view.speed = 1;
    view.aim = Vec(1, 0);
    view.left = 5;
    return view;
}

/// A wall across the way, as the laser sees it.
void addWall(View& view, double x) {
    for (int i = -20; i <= 20; ++i) view.points.push_back(Vec(x, 0.05 * i));
}

TEST(Orca, VelocityIsTheNearestOfThePermittedOnes) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    int solved = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<OrcaLine> lines(4);
        for (OrcaLine& line : lines) {
            line.direction = direction(kPi * unit(random));
            line.point = Vec(0.8 * unit(random), 0.8 * unit(random));
        }
        const Vec wanted(unit(random), unit(random));
        const Vec found = orcaVelocity(lines, 0, 1, wanted);
        EXPECT_LE(length(found), 1 + 1e-9);
        const auto breaks = [&lines](Vec v) {
            double most = 0;
            for (const OrcaLine& line : lines)
                most = std::max(most, cross(line.direction, line.point - v));
            return most;
        };
        // The best of a grid: nearest to the wanted one if any is permitted, else least beyond.
        double nearest = 1e9, least = 1e9;
        for (int i = -50; i <= 50; ++i)
            for (int j = -50; j <= 50; ++j) {
                const Vec v(0.02 * i, 0.02 * j);
                if (length(v) > 1) continue;
                least = std::min(least, breaks(v));
                if (breaks(v) <= 0) nearest = std::min(nearest, length(v - wanted));
            }
        if (nearest < 1e9) {
            ++solved;
            EXPECT_LT(breaks(found), 1e-6) << round;
            EXPECT_LT(length(found - wanted), nearest + 1e-9) << round;
        } else if (least > 0.05) {
            EXPECT_LT(breaks(found), least + 1e-6) << round;
        }
    }
    EXPECT_GT(solved, 50);
}

TEST(Orca, LineKeepsTheRelativeVelocityOutOfTheCone) {
    // Two that come at each other, a little off: both do half of it, and pass.
    const Vec offset(4, 0.2), mine(1, 0), other(-1, 0);
    const OrcaLine line = orcaLine(offset, mine, other, 0.6, 3, 0.1, 0.5);
    EXPECT_GT(cross(line.direction, line.point - mine), 0) << "the present velocity is refused";
    std::vector<OrcaLine> lines(1, line);
    const Vec a = orcaVelocity(lines, 0, 2, mine);
    lines[0] = orcaLine(Vec(-4, -0.2), other, mine, 0.6, 3, 0.1, 0.5);
    const Vec b = orcaVelocity(lines, 0, 2, other);
    double least = 1e9;
    for (double t = 0; t <= 3; t += 0.01) least = std::min(least, length(offset + t * (b - a)));
    EXPECT_GT(least, 0.6 - 1e-6);
    EXPECT_LT(least, 0.65);
}

TEST(Planners, AllGoStraightWhereTheWayIsFree) {
    for (Drive (*const planner)(const View&, const Body&) : {goalOnly, dynamicWindow, reciprocal}) {
        const Drive drive = planner(viewAhead(), robotBody());
        EXPECT_GT(drive.speed, 0.95);
        EXPECT_LT(std::abs(drive.turn), 0.2);
    }
}

TEST(Planners, GoalOnlyDoesNotSeeAWallAndTheOthersBrakeBeforeIt) {
    View view = viewAhead();
    addWall(view, 0.6);
    EXPECT_GT(goalOnly(view, robotBody()).speed, 0.95);
    EXPECT_LT(dynamicWindow(view, robotBody()).speed, 0.8);
    EXPECT_LT(reciprocal(view, robotBody()).speed, 0.5);
}

TEST(Planners, TheOthersTurnAsideFromAPerson) {
    View view = viewAhead();
    Neighbour one;
    one.place = Vec(1.5, 0.1);
    one.radius = 0.255;
    view.people.push_back(one);
    for (int i = 0; i < 24; ++i) view.points.push_back(one.place + 0.2 * direction(i * kPi / 12));
    EXPECT_EQ(goalOnly(view, robotBody()).turn, 0);
    // The person stands a little to the left: they pass on the right.
    EXPECT_LT(dynamicWindow(view, robotBody()).turn, -0.2);
    EXPECT_LT(reciprocal(view, robotBody()).turn, -0.2);
}

}  // namespace
}  // namespace social
