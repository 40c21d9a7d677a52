// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/days: days of people, lines of scripts such as `daily 07:30 ann goes kitchen`.
//
// The course of a day is the same for any number of threads: searches for ways are counted in
// cells, not in seconds.
//
//     DayPlan plan = readDayPlan("at 07:30 ann uses kettle 3min\n", "week.txt", world);
//     simulation.follow(std::make_shared<ActivityDirector>(std::move(plan)));
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/days/goal_paths.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "geom/predicates.h"
#include "sim/command.h"
#include "sim/script_lines.h"
#include "sim/shut_doors.h"
#include "sim/sim_time.h"

namespace ispace {

class Simulation;
class World;

}  // namespace ispace

namespace ispace::days {

struct DeedMoment;
struct PersonDeed;
struct PersonVerb;

/// A piece of an activity.
struct DayAction {
    enum class Verb {
        Goes,   ///< to the zone or element `target`
        Uses,   ///< likewise, and stays there
        Stays,  ///< where the person is
        Acts,   ///< on the actuator `target`, at once
        Does    ///< with its body, see PersonVerb
    };
    Verb verb = Verb::Stays;
    std::string text;  ///< as in the script: "uses kettle 3min"
    std::string target;
    std::string act;      ///< of Acts: the verb, "opens"
    std::string changes;  ///< likewise, of its states, unless its kind has others: "open=yes"
    SimTime lasts{};
    const PersonVerb* does = nullptr;  ///< of Does
    std::string object;                ///< likewise, see DeedMoment
    std::string onward;                ///< likewise: the target of PersonVerb::then
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

/// Reads the lines of a script that belong to a plan:
///
///     at [DAY] HH:MM[:SS] PERSON [NAME:] ACTION; ACTION …
///     daily HH:MM[:SS] PERSON [NAME:] ACTION; ACTION …
///
/// DAY counts from 1. An action is `goes ID`, `uses ID DURATION`, `stays DURATION`, `opens DOOR`,
/// `closes DOOR`, `switches ID on|off`, a verb of a thing (see ThingKind) with its ID, or one of
/// people (see PersonVerb); zones and elements are named by their ids. Without a NAME an activity
/// has the name of its first action. \throws FormatError with all findings
DayPlan readDayPlan(std::string_view text, const std::string& file, const World& world);
/// Reads them as a kind of script lines (see ScriptLines). Null if there are none.
std::shared_ptr<Director> readDays(std::string_view text, const std::string& file,
                                   const World& world);
/// Adds these lines to those that scripts may have. Called once, before the first is read.
void addDays();

/// Makes people follow their days: each does the activities of a plan one after another, each at
/// its time or once those before it are done. A person on the way finds it round walls, elements
/// and shut doors, and ends it beside the thing, see GoalPaths::isAt(); one that is blocked tries
/// again five times, a second apart, and then gives the action up. So does a person that is led
/// away from the thing it uses.
///
/// Shut doors that let the person pass (see ThingKind) are on its way, too: in front of one it
/// stands and opens it, and the door is shut behind it once the doorway is free, and no program
/// keeps the door open, see Simulation::keepOpen().
///
/// Searches for ways are limited in each step, by the cells that they look at: the others of a
/// crowd that sets out at once stand until it is their turn, which they get in the order in which
/// they wanted to go. So do those of a crowd that give up, and look for the doors in their way.
class ActivityDirector final : public Director {
  public:
    explicit ActivityDirector(DayPlan plan);
    ActivityDirector(const ActivityDirector&) = delete;
    ActivityDirector& operator=(const ActivityDirector&) = delete;
    /// Starts and ends actions, and raises their events.
    void stepped(Simulation& simulation) override;
    [[nodiscard]] bool hasOpened(const std::string& door) const override {
        return opened_.contains(door);
    }

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
        bool is_doing = false;     // a deed that ends with a change
        bool is_cut = false;       // the line under way ends for the next one
        Pose2 stood;               // when that began
        bool to_door = false;      // the way ends in front of a door, which it then opens
        int asks = 0;              // for a door to open, since the person came to it
    };
    /// The ways of a person, through the shut doors that let it pass.
    struct Paths {
        std::vector<ShutDoor> doors;
        std::shared_ptr<const GoalPaths> goals;
    };
    /// A door that is open for people.
    struct OpenedDoor {
        ShutDoor door;                      // as it was before
        std::string after;                  // the changes behind them
        std::map<std::string, Turn> users;  // the side from which each one comes
        bool is_shutting = false;           // asked for in the step before
    };
    void enqueue(SimTime now);
    void goOn(Simulation& simulation, Doer& doer);
    void cut(Simulation& simulation, Doer& doer);
    bool begin(Simulation& simulation, Doer& doer) const;
    static bool goOnWalking(World& world, std::size_t mover, Doer& doer);
    bool depart(Simulation& simulation, std::size_t mover, Doer& doer);
    void arrive(World& world, std::size_t mover, Doer& doer);
    bool isThere(const World& world, std::size_t mover, const Doer& doer);
    void stay(const World& world, std::size_t mover, Doer& doer) const;
    bool beginWithBody(Simulation& simulation, Doer& doer) const;
    void askDeed(Simulation& simulation, Doer& doer,
                 PersonDeed (*deed)(const DeedMoment& moment)) const;
    void beginDeed(Simulation& simulation, Doer& doer) const;
    bool face(World& world, std::size_t mover, Doer& doer);
    [[nodiscard]] DeedMoment momentOf(const World& world, std::size_t mover,
                                      const Doer& doer) const;
    void refuse(Simulation& simulation, Doer& doer, const std::string& reason) const;
    void beginUse(Simulation& simulation, Doer& doer) const;
    void endUse(Simulation& simulation, Doer& doer) const;
    void watchStay(const World& world, std::size_t mover, Doer& doer);
    [[nodiscard]] std::vector<GoalPaths::Spot> spotsOfOthers(const World& world,
                                                             std::size_t mover) const;
    Paths waysOf(const World& world, std::size_t mover);
    std::shared_ptr<const GoalPaths> waysThrough(const World& world, double height,
                                                 std::span<const ShutDoor> doors);
    bool awaitDoor(Simulation& simulation, std::size_t mover, Doer& doer, const ShutDoor& door);
    void passOpened(const World& world, std::size_t mover, const std::vector<Point2>& way);
    void closeDoors(Simulation& simulation);
    [[nodiscard]] bool isPassing(const World& world, const std::string& person,
                                 const OpenedDoor& opened) const;
    bool act(Simulation& simulation, Doer& doer) const;
    std::string barriersOf(const World& world, std::size_t mover, const Doer& doer);
    void notify(Simulation& simulation, const Doer& doer, int value) const;
    void notifyUnreached(Simulation& simulation, std::size_t mover, const Doer& doer);
    [[nodiscard]] const DayAction& actionOf(const Doer& doer) const {
        return plan_.lines[*doer.line].actions[doer.action];
    }

    DayPlan plan_;
    std::vector<SimTime> next_;  // of each line; kMaxTime: never again
    SimTime due_{};              // the earliest of them
    std::map<std::string, Doer> doers_;
    std::vector<Doer*> waiting_;  // for their turn, the first one longest
    std::int64_t work_left_;      // cells to look at before others wait; negative: a debt
    // By the height of people, and the ids of the shut doors that are taken as open.
    struct KeptPaths {
        std::shared_ptr<const GoalPaths> goals;
        std::int64_t last_use = 0;
    };
    std::map<std::pair<double, std::string>, KeptPaths> ways_;
    std::int64_t ways_uses_ = 0;
    std::vector<ShutDoor> shut_doors_;  // of the world
    std::int64_t ways_of_ = -1;         // changes of the world then
    std::map<std::string, OpenedDoor> opened_;
};

}  // namespace ispace::days
