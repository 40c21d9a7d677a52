// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/learning: many worlds of a room that a learner drives, `simrun --vector N`. Uses
// cli and below.
//
// The task that the robots of such worlds are given: rewards, ends and truncations are rows over a
// fixed list of signals, and a YAML file may hold them.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "sim/sim_time.h"

namespace ispace::learning {

/// The quantities of a step that rows of a task weigh and test.
enum class TaskSignal {
    Step,          ///< 1
    Steps,         ///< steps of the episode so far
    Reached,       ///< 1 if the robot came to its goal in this step
    Collision,     ///< 1 if it ran into a body
    Progress,      ///< metres by which the straight line to the goal became shorter
    PathProgress,  ///< metres by which the way to the goal round walls became shorter
    Distance,      ///< metres to the goal
    Clearance,     ///< least range of the laser, metres
    Speed,         ///< m/s, forward
    Turn,          ///< radians turned, of either sign
    Change,        ///< change of both actions against the last step, their absolute values added
    NewFloor,      ///< square metres of floor that it came near for the first time
    Floor,         ///< share of the floor that it has come near
    Gap,           ///< metres by which it is out of the band of distances at which it follows
    Aim,           ///< radians between its heading and that of the dock
    kCount
};
constexpr std::size_t kTaskSignals = static_cast<std::size_t>(TaskSignal::kCount);

/// Returns the name of a signal in a task file: "way_progress".
std::string_view nameOf(TaskSignal signal);

/// A row of a task. As a reward it adds weight times the signal if the signal lies between the
/// bounds; as an end or a truncation it tests the bounds. Without bounds the signal must be above 0
/// to end an episode, and counts always as a reward.
struct TaskRow {
    TaskSignal signal = TaskSignal::Step;
    double weight = 1;
    double above = -std::numeric_limits<double>::infinity();
    double below = std::numeric_limits<double>::infinity();
    bool is_success = false;  ///< of an end: the task is done

    [[nodiscard]] bool holds(double value) const { return value > above && value < below; }
};

/// An interval, ends included.
struct TaskRange {
    double low = 0, high = 0;
    [[nodiscard]] bool isOne() const { return low == high; }
};

/// Rooms that differ from the given one: pieces of furniture are left out, moved and turned, and
/// doors are closed. Variants that are no valid room, or in which robots have no goal, are drawn
/// anew.
struct FurnitureRange {
    int variants = 0;       ///< rooms besides the given one
    double remove = 0;      ///< share of pieces left out
    double shift = 0;       ///< metres, at most, along x and along y
    double turn = 0;        ///< degrees, at most, to either side
    double close_door = 0;  ///< share of open doors that are closed
};

/// A task with its defaults: goal reaching by one robot without people.
struct LearningTask {
    enum class Kind {
        Goal,    ///< to come to a point
        Follow,  ///< to stay near a person
        Patrol,  ///< to come near all of the floor; the goal is the nearest floor still to see
        Dock     ///< to stand before a wall, facing it
    };
    Kind kind = Kind::Goal;
    SimTime step = std::chrono::milliseconds(100);
    int robots = 1;  ///< of a world, if no layout has any
    TaskRange people{0, 0};
    TaskRange distance{3, 8};  ///< of the goal at the start, metres along a straight line
    double detour = 1.5;       ///< most metres of way for a metre of straight line
    double reach = 0.3;        ///< metres from the goal at which it is reached
    std::string zone = {};     ///< whose middle is the goal, of Kind::Goal; "": goals are drawn
    /// Robots and people begin where the scene has them, and all of its people are there; else
    /// their starts are drawn.
    bool starts_in_scene = false;
    TaskRange band{0.8, 1.5};  ///< of distances to follow at, metres between centres
    double near = 1;           ///< metres within which patrolled floor counts
    std::vector<TaskRow> rewards, ends, truncations;
    // Ranges of what an episode draws.
    TaskRange speed{1, 1}, accel{1, 1};  ///< factors of the robots' limits
    TaskRange sigma{0, 0};               ///< standard deviation of ranges, metres
    TaskRange dropout{0, 0};             ///< share of lost returns
    FurnitureRange furniture;

    [[nodiscard]] bool isNoisy() const { return sigma.high > 0 || dropout.high > 0; }
};

/// Returns the rows that a kind of task has by default.
LearningTask defaultTask(LearningTask::Kind kind);

/// Reads a task file, YAML with the keys `task`, `step`, `robots`, `people`, `goal`, `follow`,
/// `patrol`, `rewards`, `ends`, `truncations` and `randomise`; keys that are left out keep the
/// defaults of the kind; `starts: scene` for starts_in_scene. \throws FormatError at the line of an
/// unknown key, word or bad number
LearningTask readTask(std::string_view bytes, const std::string& name);

}  // namespace ispace::learning
