// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/point.h"
#include "sim/command.h"
#include "sim/goal_ways.h"
#include "sim/sim_time.h"

namespace ispace {

class Simulation;
class World;

/// A piece of an activity.
struct DayAction {
    enum class Verb {
        Goes,   ///< to the zone or element `target`
        Uses,   ///< likewise, and stays there
        Stays,  ///< where the person is
        Acts    ///< on an actuator: `change` is the request
    };
    Verb verb = Verb::Stays;
    std::string text;  ///< as in the script: "uses kettle 3min"
    std::string target, change;
    SimTime lasts{};
};

/// An activity of a person.
struct DayLine {
    SimTime time{};  ///< since midnight of the first day, at which a run begins
    bool is_daily = false;
    std::string person, name;
    std::vector<DayAction> actions;
};

/// The days of people.
struct DayPlan {
    std::vector<DayLine> lines;  ///< sorted by time
};

/// Returns true if a line of a script belongs to a plan: it begins with `at` or `daily`.
bool isDayLine(std::string_view line);

/// Reads the lines of a script that belong to a plan:
///
///     at [DAY] HH:MM[:SS] PERSON [NAME:] ACTION; ACTION …
///     daily HH:MM[:SS] PERSON [NAME:] ACTION; ACTION …
///
/// DAY counts from 1. An action is `goes ID`, `uses ID DURATION`, `stays DURATION`, `opens DOOR`,
/// `closes DOOR`, or `switches ID on|off`; zones and elements are named by their ids. Without a
/// NAME an activity has the name of its first action. \throws FormatError with all findings
DayPlan readDayPlan(std::string_view text, const std::string& file, const World& world);

/// Makes people follow their days: each does the activities of a plan one after another, each at
/// its time or once those before it are done. A person on the way finds it round walls, elements
/// and shut doors, and ends it beside the thing, see GoalWays::isAt(); one that is blocked tries
/// again five times, a second apart, and then gives the action up. So does a person that is led
/// away from the thing it uses.
///
/// Searches for ways are limited in each step, by the cells that they look at: the others of a
/// crowd that sets out at once stand until it is their turn, which they get in the order in which
/// they wanted to go.
class ActivityDirector {
  public:
    explicit ActivityDirector(DayPlan plan);
    ActivityDirector(const ActivityDirector&) = delete;
    ActivityDirector& operator=(const ActivityDirector&) = delete;
    /// Starts and ends actions, and raises their events. Call it after each step.
    void stepped(Simulation& simulation);

  private:
    struct Doer {
        std::vector<std::size_t> waiting;  // lines, in order
        std::optional<std::size_t> line;   // under way
        std::size_t action = 0;
        bool is_begun = false, walks = false, gave_up = false;
        int command = 0;            // of the way
        Point2 goal;                // likewise
        std::vector<Command> rest;  // of it, the next one last
        int tries = 0;
        SimTime until{};
        Point2 stays_at;           // of a stay that `uses` a thing
        std::int64_t changes = 0;  // of the world then
        bool waits = false;        // for its turn to look for a way
        std::string after_use;     // the change that ends the use of a thing; "" for none
    };
    void enqueue(SimTime now);
    void goOn(Simulation& simulation, Doer& doer);
    bool begin(Simulation& simulation, Doer& doer) const;
    static bool goOnWalking(World& world, std::size_t mover, Doer& doer);
    bool depart(Simulation& simulation, std::size_t mover, Doer& doer);
    void arrive(World& world, std::size_t mover, Doer& doer);
    bool isThere(const World& world, std::size_t mover, const Doer& doer);
    void stay(const World& world, std::size_t mover, Doer& doer) const;
    void beginUse(Simulation& simulation, Doer& doer) const;
    void endUse(Simulation& simulation, Doer& doer) const;
    void watchStay(const World& world, std::size_t mover, Doer& doer);
    [[nodiscard]] std::vector<GoalWays::Spot> spotsOfOthers(const World& world,
                                                            std::size_t mover) const;
    const GoalWays& waysOf(const World& world, double height);
    void tell(Simulation& simulation, const Doer& doer, int value) const;
    void tellUnreached(Simulation& simulation, const Doer& doer) const;
    [[nodiscard]] const DayAction& actionOf(const Doer& doer) const {
        return plan_.lines[*doer.line].actions[doer.action];
    }

    DayPlan plan_;
    std::vector<SimTime> next_;  // of each line; kMaxTime: never again
    SimTime due_{};              // the earliest of them
    std::map<std::string, Doer> doers_;
    std::vector<Doer*> waiting_;  // for their turn, the first one longest
    std::int64_t work_left_;      // cells to look at before others wait; negative: a debt
    std::map<double, std::shared_ptr<const GoalWays>> ways_;  // by the height of people
    std::int64_t ways_of_ = -1;                               // changes of the world then
};

}  // namespace ispace
