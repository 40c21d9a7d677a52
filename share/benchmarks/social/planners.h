// SPDX-License-Identifier: GPL-3.0-or-later
// Three planners: each chooses a speed and a rate of turning ten times a second.
#ifndef SOCIAL_PLANNERS_H
#define SOCIAL_PLANNERS_H

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "orca.h"
#include "plane.h"

namespace social {

/// A person as the robot perceives her.
struct Neighbour {
    Vec place, velocity;
    double radius = 0;
};

/// All that a planner knows at a moment; places are in the room, angles in radians.
struct View {
    Vec place;
    double heading = 0, speed = 0, turn = 0;  ///< m/s, rad/s
    Vec aim;                                  ///< point of the way ahead, 1 m from the robot
    double left = 0;                          ///< metres of way to the goal
    std::vector<Vec> points;                  ///< returns of the laser
    std::vector<Neighbour> people;            ///< in view
};

/// Returns true if a person in view explains a return of the laser.
inline bool isOnPerson(const View& view, Vec point) {
    return std::any_of(view.people.begin(), view.people.end(), [point](const Neighbour& one) {
        return length(point - one.place) < one.radius + 0.2;
    });
}

/// The robot's limits.
struct Body {
    double radius = 0, speed = 0, turn = 0, accel = 0, turn_accel = 0;
};

struct Drive {
    double speed = 0, turn = 0;
};

constexpr double kInterval = 0.1;  ///< seconds from one choice to the next

/// Turns towards a velocity and drives at the part of it that lies ahead.
inline Drive driveTo(Vec velocity, const View& view, const Body& body) {
    const double speed = length(velocity);
    if (speed < 1e-3) return Drive();
    const double off = wrapped(angleOf(velocity) - view.heading);
    Drive drive;
    drive.turn = std::max(-body.turn, std::min(body.turn, off / 0.3));
    drive.speed = std::min(body.speed, speed * std::max(0.0, std::cos(off)));
    return drive;
}

/// Goal only: along the way round the walls, as if there were no people.
inline Drive goalOnly(const View& view, const Body& body) {
    const Vec way = view.aim - view.place;
    return driveTo(
        (std::min(body.speed, std::sqrt(2 * body.accel * view.left)) / length(way)) * way, view,
        body);
}

/// Dynamic window (Fox, Burgard, Thrun, The Dynamic Window Approach to Collision Avoidance, 1997):
/// of the speeds that it can have in a quarter of a second, the best arc that leaves time to brake
/// before what the laser sees, which it takes to stand still.
inline Drive dynamicWindow(const View& view, const Body& body) {
    constexpr double kWindow = 0.25, kHorizon = 2, kStep = 0.1, kLook = 0.6, kFar = 0.6, kGap = 0.2,
                     kHair = 0.005;
    constexpr int kSpeeds = 6, kTurns = 15;
    const auto sample = [](double at, double change, double low, double high, int i, int count) {
        const double from = std::max(low, at - change), to = std::min(high, at + change);
        return from + (to - from) * i / (count - 1);
    };
    std::vector<Vec> near;
    for (const Vec point : view.points)
        if (length(point - view.place) < body.speed * kHorizon + body.radius + kFar)
            near.push_back(point);
    // One that already stands nearer may leave.
    double gap = kGap;
    for (const Vec point : near)
        gap = std::min(gap, length(point - view.place) - body.radius - kHair);
    Drive best;
    double most = -std::numeric_limits<double>::infinity();
    const double cruise = std::min(body.speed, std::sqrt(2 * body.accel * view.left));
    for (int i = 0; i < kSpeeds; ++i) {
        const double speed = sample(view.speed, body.accel * kWindow, 0, cruise, i, kSpeeds);
        for (int j = 0; j < kTurns; ++j) {
            const double turn =
                sample(view.turn, body.turn_accel * kWindow, -body.turn, body.turn, j, kTurns);
            Vec place = view.place;
            double heading = view.heading, clear = kFar, free = kHorizon, off = kPi;
            for (double t = kStep; t < kHorizon + kStep / 2; t += kStep) {
                place = place + (speed * kStep) * direction(heading + turn * kStep / 2);
                heading += turn * kStep;
                double least = kFar;
                for (const Vec point : near)
                    least = std::min(least, length(point - place) - body.radius);
                if (t <= kLook + kStep / 2)
                    off = std::abs(wrapped(angleOf(view.aim - place) - heading));
                if (least < gap) {
                    free = t - kStep;
                    break;
                }
                clear = std::min(clear, least);
            }
            // It comes to rest before the obstacle.
            if (speed > 0 && free < kHorizon && speed / (2 * body.accel) + kInterval > free)
                continue;
            const double value = rounded(0.6 * (1 - off / kPi) + 0.2 * std::max(0.0, clear) / kFar +
                                         0.4 * free / kHorizon + speed / body.speed);
            if (value > most) {
                most = value;
                best.speed = speed;
                best.turn = turn;
            }
        }
    }
    // Without any arc it brakes.
    return best;
}

/// Optimal reciprocal collision avoidance (van den Berg et al., Reciprocal n-Body Collision
/// Avoidance, 2011): the velocity nearest to that towards the aim which avoids people for three
/// seconds, if those that walk do half of it, and the walls for one.
inline Drive reciprocal(const View& view, const Body& body) {
    constexpr double kPeopleTime = 3, kWallTime = 1, kGap = 0.1, kWallGap = 0.03;
    constexpr double kStanding = 0.1, kAside = 0.03;
    const Vec velocity = view.speed * direction(view.heading);
    std::vector<OrcaLine> lines;
    for (const Vec point : view.points) {
        const Vec offset = point - view.place;
        const double apart = length(offset);
        const bool is_person = std::any_of(
            view.people.begin(), view.people.end(),
            [point](const Neighbour& one) { return length(point - one.place) < one.radius + 0.2; });
        if (is_person || apart > body.speed * kWallTime + body.radius + kWallGap) continue;
        const Vec normal = (1 / apart) * offset;
        const double most = (apart - body.radius - kWallGap) / kWallTime;
        OrcaLine line;
        line.point = most * normal;
        line.direction = Vec(-normal.y, normal.x);
        lines.push_back(line);
    }
    const std::size_t walls = lines.size();
    for (const Neighbour& one : view.people)
        lines.push_back(orcaLine(one.place - view.place, velocity, one.velocity,
                                 body.radius + one.radius + kGap, kPeopleTime, kInterval,
                                 length(one.velocity) < kStanding ? 1 : 0.5));
    const Vec way = view.aim - view.place;
    const double cruise = std::min(body.speed, std::sqrt(2 * body.accel * view.left));
    // A little to the right, or it stands before one that is straight ahead.
    const Vec wanted = cruise * direction(angleOf(way) - kAside);
    const Vec chosen = orcaVelocity(lines, walls, body.speed, wanted);
    return driveTo(Vec(rounded(chosen.x), rounded(chosen.y)), view, body);
}

}  // namespace social

#endif  // SOCIAL_PLANNERS_H
