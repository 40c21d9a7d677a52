// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/navigation: how a robot went to its goal among people, by the record of the run.
// Uses cli and below.
//
// The figures follow Francis et al., Principles and Guidelines for Evaluating Social Robot
// Navigation Algorithms (2023), and Anderson et al., On Evaluation of Embodied Navigation Agents
// (2018) for SPL. Each stands by itself: there is no score over all of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/point.h"

namespace ispace::navigation {

/// A person in the room of the robot.
struct PersonGap {
    std::size_t person = 0;  ///< a number that stays with the person
    double gap = 0;          ///< metres between the circles of both, below 0 if they overlap
};

/// A moment of a run, as the robot's figures need it.
struct NavigationMoment {
    double time = 0;  ///< seconds
    Point2 place;     ///< of the robot
    /// A number of its room. Places of different rooms have no distance: the way from one to the
    /// other counts as 0.
    std::size_t room = 0;
    std::vector<PersonGap> people = {};
};

/// A movement that a collision ended.
struct NavigationContact {
    enum class Kind {
        Person,        ///< the robot and a person, whichever moved
        Robot,         ///< the robot and another one
        Thing,         ///< the robot and a wall or an element
        BetweenPeople  ///< two people
    };
    double time = 0;
    Kind kind = Kind::Thing;
    std::string pair;  ///< both ids, in an order that does not depend on which moved
};

/// A robot's run.
struct NavigationRun {
    std::vector<NavigationMoment> moments;    ///< times ascend
    std::vector<NavigationContact> contacts;  ///< likewise
};

/// Where the robot was to go.
struct NavigationGoal {
    Point2 place;
    std::size_t room = 0;
    double reach = 0.5;              ///< metres from its centre to the place at which it has come
    std::optional<double> way = {};  ///< length of the shortest way to within `reach`, metres
};

/// Times that a person came nearer than a distance, and the seconds during which any was.
struct Intrusions {
    std::size_t count = 0;
    double seconds = 0;
};

/// Limits of the definitions.
constexpr double kIntimateSpace = 0.45, kPersonalSpace = 1.2;  // metres, Hall 1966
constexpr double kStandingSpeed = 0.05;                        // m/s
constexpr double kStopTime = 0.5;                              // seconds
constexpr double kSameContact = 1;                             // seconds
constexpr double kJerkInterval = 0.1;                          // seconds

/// The figures of a run, from its beginning to the arrival, else to its end.
struct NavigationFigures {
    bool success = false;         ///< the robot came within `reach` of the goal
    std::optional<double> time;   ///< to the goal, seconds
    double duration = 0;          ///< judged, seconds
    double path = 0;              ///< metres that its centre went
    std::optional<double> way;    ///< as given
    std::optional<double> ratio;  ///< path / way if it arrived
    /// way / max(way, path) if it arrived, else 0: success weighted by path length.
    std::optional<double> spl;
    double speed = 0;               ///< path / duration, m/s
    std::optional<double> nearest;  ///< least gap to a person, metres; empty without people
    Intrusions intimate, personal;  ///< gaps below kIntimateSpace and kPersonalSpace
    /// Halts of at least kStopTime below kStandingSpeed, after it had set out.
    std::size_t stops = 0;
    double still = 0;  ///< seconds below kStandingSpeed, from the beginning
    /// Magnitude of the third difference of the place over h^3, where h is the least multiple of
    /// the record's interval from kJerkInterval on: mean and maximum, m/s^3. Empty for a run that
    /// is shorter than 3 h or whose moments are not equally far apart.
    std::optional<double> jerk, greatest_jerk;
    /// Collisions; those of the same pair within kSameContact of each other count once.
    std::size_t with_people = 0, with_robots = 0, with_things = 0, between_people = 0;
};

/// Computes the figures. O(moments * people) \pre a moment
NavigationFigures navigationFigures(const NavigationRun& run, const NavigationGoal& goal);

}  // namespace ispace::navigation
