// SPDX-License-Identifier: GPL-3.0-or-later
// Events of a world: collisions, zones, mats, gates, sight, states, and marks of clients.
//
// Events are facts of steps, in a fixed order, and the same in every run of the same commands. They
// are numbered; some ten thousand are kept, so that slow readers notice a gap by first().
//
// Costs. A kind without subscribers takes no time. Zones are tested for movers that moved; sight is
// tested for each sensor and mover, ten times a second, while movers move.
//
//     EventLog log(world);
//     log.want({EventKind::Collision, EventKind::Enter});
//     for (std::int64_t next = log.next(); world.time() < end;) {
//         world.step();
//         log.stepped();
//         for (; next < log.next(); ++next) print(log.at(next));
//     }
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "geom/point.h"
#include "sim/sim_time.h"

namespace ispace {

class World;

/// Kinds of events to which clients can subscribe.
enum class EventKind {
    Collision,  ///< mover `id` ran into `other` at this point
    Stall,      ///< `id` stands still until its next command
    /// `id` gave up its way to this point; `other`: the storey of the point in a trip, or the zone
    /// or element of an activity, which has no point. `text`: the reason, if known.
    Unreached,
    Enter,  ///< `id` entered the zone `other`
    Leave,
    Mat,    ///< `other` stepped on the mat `id` (value 1) or off it (0)
    Gate,   ///< `other` passed the gate `id` inwards (value 1) or outwards (0)
    Seen,   ///< `id` comes into the sight of `value` sensors, after zero
    Lost,   ///< no sensor sees `id` any more
    State,  ///< the state `other` of the sensor or actuator `id` has become `text`
    /// The person `id` begins (value 1), has done (0) or gives up (-1) the action `text` of the
    /// activity `other`.
    Activity,
    Mark,    ///< a client wrote `text`
    Change,  ///< the request `text` changed the world; `other`: file of the scene after it
};
constexpr std::size_t kEventKinds = 13;
/// Returns the name of a kind: "collision".
std::string_view nameOf(EventKind kind);
std::optional<EventKind> eventKindNamed(std::string_view name);
using EventKinds = std::set<EventKind>;
EventKinds allEventKinds();

/// An event. Fields that its kind does not name are empty.
struct Event {
    EventKind kind = EventKind::Mark;
    SimTime time{};
    std::string id = {}, other = {};
    std::optional<Point2> place = {};
    int value = 0;
    std::string text = {};
};

/// Return the header of an event table, and one event as its row: t,kind,id,other,x,y,value,text.
std::string_view eventTableHead();
void appendEventRow(std::string& out, const Event& event);

/// Watches a world step by step and reports its events.
///
/// Seen and Lost follow DetectionMonitor (sense/detection.h), ten times a second.
///
/// State follows the fields of readings that are states, and the records of roomStates(); at a
/// subscription the states count as known, and no event reports them.
///
/// Only subscribed kinds are computed. At the start all movers count as outside every zone, off
/// every mat and unseen, so those inside raise Enter, Mat or Seen at the next step. Events of one
/// step are sorted by kind, those of a kind in the world's order. A removed mover or zone raises no
/// Enter, Lost or the like.
class EventLog {
  public:
    explicit EventLog(const World& world);
    ~EventLog();
    EventLog(EventLog&&) noexcept;
    EventLog& operator=(EventLog&&) noexcept;

    /// Subscribes to these kinds.
    void want(const EventKinds& kinds);
    /// Cancels one subscription to each. Mat and State without subscribers forget what they knew,
    /// and so do Enter with Leave and Seen with Lost once neither has any: a later subscription
    /// starts anew. \pre want() was called for each
    void unwant(const EventKinds& kinds);

    /// Reads the world after a step. Keeps all events of that step until the next one, however many
    /// there are.
    void stepped();
    /// Adds an event between steps, at the world's time. \pre Mark or Change
    void add(EventKind kind, std::string text, std::string other = {});

    /// Adds an event at the world's time if its kind is subscribed. \pre Activity, Unreached of
    /// one, of a trip or of a script, or State of a thing that is not in the scene
    void notify(Event event);

    /// Events are numbered from 0 in their order; returns the number of the next one.
    [[nodiscard]] std::int64_t next() const;
    /// Returns the number of the first event that is still stored; some ten thousand are kept.
    [[nodiscard]] std::int64_t first() const;
    /// \pre first() <= number < next()
    [[nodiscard]] const Event& at(std::int64_t number) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
