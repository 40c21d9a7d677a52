// SPDX-License-Identifier: GPL-3.0-or-later
// The states of things in a run, by their names: those that events report, and power.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/point.h"
#include "sim/events.h"
#include "sim/world.h"

namespace ispace::expect {

/// A world that is judged, with its name among others ("" of the only one).
struct JudgedWorld {
    std::string id;
    const World* world = nullptr;
    EventLog* events = nullptr;  ///< null: states are read after each step
};

/// A state of a thing.
struct ThingState {
    std::string text = "0";  ///< as events report it: "1", "0.4", "h1,h2"
    double number = 0;       ///< NaN if it is a word
    bool is_on = false;      ///< neither 0 nor empty
    bool is_there = true;    ///< false once its record was removed
    bool is_told = true;     ///< false while it is 0 only because no event told another value
};

/// A record of a room that has states, or may be told some.
struct Thing {
    std::string name;  ///< with its room: "upper/lamp1"
    std::string keyword;
    std::size_t room = 0;
    std::optional<Point2> at = {};  ///< on the floor of its room, at the start
    std::vector<std::string> keys = {};
};

/// Follows the states of all things of a run.
///
/// Besides the states of roomStates() and of readings, things with a power have `watts`, from their
/// record (`watts`, `level`, `on`) or a state `power`, and `kwh`, its integral since the beginning.
class ThingStates {
  public:
    /// The worlds must outlive it.
    explicit ThingStates(std::span<const JudgedWorld> worlds);

    /// Reads the worlds after a step. O(changes), after a change of a world O(records)
    void observe();

    /// Returns the things that were there at the start.
    [[nodiscard]] const std::vector<Thing>& things() const { return things_; }
    /// Returns a state, at an address that stays; null for a key that the thing has not. A thing
    /// without states of its own may be told any, which is 0 until then. \pre things() has it
    [[nodiscard]] const ThingState* find(const Thing& thing, std::string_view key);
    /// Returns the names of the states that find() gave and that were never told: "bed.occupied".
    [[nodiscard]] std::vector<std::string> untold() const;

  private:
    struct Power {
        std::string name;
        std::size_t room = 0;
        double watts = 0, joules = 0;
    };

    void read(std::size_t room, bool is_first);
    void set(std::size_t room, const std::string& name, std::string_view key, std::string text);

    std::vector<JudgedWorld> worlds_;
    std::vector<std::int64_t> changes_, next_;  // of each world: its changes, the next event
    std::vector<Thing> things_;
    std::map<std::string, ThingState, std::less<>> states_;  // by NAME.KEY
    std::map<std::string, Power, std::less<>> powers_;       // by name
    SimTime time_{};
};

}  // namespace ispace::expect
