// SPDX-License-Identifier: GPL-3.0-or-later
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

/// What happens in a world that somebody may want to be told.
enum class EventKind {
    Collision,  ///< `id` ran into `other` at `place`
    Stall,      ///< `id` stands still until its next command, from then on
    Enter,      ///< `id` came into the zone `other`
    Leave,
    Mat,     ///< `other` stepped on the mat `id` (value 1) or off it (0)
    Gate,    ///< `other` passed the gate `id`, the way in (value 1) or out (0)
    Seen,    ///< `id` comes into sight of `value` sensors, after none
    Lost,    ///< no sensor sees `id` any more
    Mark,    ///< somebody wrote `text`
    Change,  ///< the world was changed by the request `text`; `other`: file of the scene after it
};
constexpr std::size_t kEventKinds = 10;
/// "collision".
std::string_view nameOf(EventKind kind);
std::optional<EventKind> eventKindNamed(std::string_view name);
using EventKinds = std::set<EventKind>;
EventKinds allEventKinds();

struct Event {
    EventKind kind = EventKind::Mark;
    SimTime time{};
    std::string id = {}, other = {};
    std::optional<Point2> place = {};
    int value = 0;
    std::string text = {};
};

/// The head of a table of events, and one as its row: t,kind,id,other,x,y,value,text.
std::string_view eventTableHead();
void appendEventRow(std::string& out, const Event& event);

/// Watches a world step by step and says what happened.
///
/// Seen and Lost are as class Watch (sense/detection.h) defines them, ten times a second.
///
/// Only kinds that somebody wants are looked for. Watching begins with nobody in a zone, on a mat
/// or in sight: whoever is enters, steps on it, is seen at the next step. Events of one step are in
/// the order of their kinds, those of a kind in the order of the world's. Who or what is removed
/// from the world neither leaves nor is lost.
class EventLog {
  public:
    explicit EventLog(const World& world);
    ~EventLog();
    EventLog(EventLog&&) noexcept;
    EventLog& operator=(EventLog&&) noexcept;

    /// Somebody wants these from now on.
    void want(const EventKinds& kinds);
    /// And no more. \pre as often as wanted
    void unwant(const EventKinds& kinds);

    /// Looks at the world after a step.
    void stepped();
    /// What happened between steps, at the world's time. \pre Mark or Change
    void add(EventKind kind, std::string text, std::string other = {});

    /// Events have numbers from 0 in their order: that of the next one.
    [[nodiscard]] std::int64_t next() const;
    /// The first that is still there; some ten thousand are kept.
    [[nodiscard]] std::int64_t first() const;
    /// \pre first() <= number < next()
    [[nodiscard]] const Event& at(std::int64_t number) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
