// SPDX-License-Identifier: GPL-3.0-or-later
// The interface between a server and the one or the many rooms of a run.
//
// Rooms step together and share one time. Each has its own world, frame and ids of things; movers
// keep their ids and the numbers of their commands from room to room. A trip is one command with
// one id and one end, however many rooms it leads through. Refusals are texts for the client, "" if
// it is done; the functions throw for broken files alone.
//
//     const TripAnswer answer = worlds.travel("r1", {.points = {{upper, {1, 2}}}});
//     if (!answer.refusal.empty()) reply("ERR 409 " + answer.refusal);
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/point.h"
#include "geom/polygon.h"
#include "geom/pose.h"
#include "scene/room_state.h"
#include "sim/simulation.h"

namespace ispace {

/// A world of a run.
struct RunRoom {
    std::string id;                    ///< "": the only one, see SoleWorld
    Simulation* simulation = nullptr;  ///< the first one leads the others
};

/// Where a room is now, in the coordinates of all worlds.
struct RoomFrame {
    Pose3 pose;              ///< of the room's frame, on its floor
    bool is_storey = false;  ///< else it is the cabin of a lift, which moves, or a flight of stairs
};

/// A point of one of the worlds.
struct RoomPoint {
    std::size_t room = 0;
    Point2 at;
};

/// Points to which a mover goes, one after another.
struct TripPlan {
    std::vector<RoomPoint> points;
    double speed = 0;                   ///< m/s; 0: the mover's
    double pause = 0;                   ///< seconds to stay at each point
    bool loop = false;                  ///< from the last point to the first, repeatedly
    std::optional<Angle> heading = {};  ///< to which it turns at the last point
};

/// A plan, or the reason why a text is none, and the word that is at fault.
struct ParsedTrip {
    TripPlan plan = {};
    std::string fault = {};
    std::size_t word = 0;
};

/// Parses the words of `GOTO upper/1,2,90 speed=0.3`, or of `PATH upper/1,2;3,4` with the keys of
/// PATH. A point without a room is one of that of the point before, at first of `room`. \pre there
/// are two words or more
ParsedTrip parseTrip(std::span<const std::string_view> words, std::span<const RunRoom> rooms,
                     std::size_t room);

/// A trip that was asked for, or the reason why it cannot begin.
struct TripAnswer {
    std::string refusal = {};                 ///< "": it has begun
    int id = 0;                               ///< among the commands of the mover
    double length = 0;                        ///< metres to go by itself, not in lifts
    std::string via = {};                     ///< ids of the passages, separated by commas
    std::optional<RoomPoint> unreached = {};  ///< the point to which no way leads, if refused so
};

/// The end of a trip.
struct TripEnd {
    std::string mover;
    int id = 0;
    Outcome outcome = Outcome::Done;
    SimTime time{};
};

/// A lift at a moment.
struct LiftState {
    std::string id, storey;  ///< storey: that of the nearest floor
    double height = 0;       ///< of its floor, metres
    double door = 0;         ///< open share of its width
    std::vector<std::string> riders;
    std::vector<std::string> calls;  ///< storeys, in the order in which it serves them
};

/// Stairs, a lift or a shaft, on the floor of a room, for plans.
struct PassageOutline {
    std::string id;
    std::string kind;  ///< its keyword
    /// In the room. Of stairs: from the foot's right corner to the head's, its left one, and that
    /// of the foot.
    Polygon outline;
};

/// A part of a trip that is still to come.
struct PlannedPath {
    std::string mover;
    std::vector<Point2> points = {};  ///< in the frame of its storey
};

/// Returns its states, as those of sensors: `storey`, and `open`, 1 unless its door is closed.
std::vector<RoomState> statesOf(const LiftState& lift);

/// Worlds that step together, and between which movers go. The ids of movers, and of the sensors
/// that they carry, are unique in all of them. The server reads the one or the many worlds of a run
/// through this interface.
class Worlds {
  public:
    virtual ~Worlds() = default;
    /// Returns true if movers, lifts and records belong to all rooms together: movers come at the
    /// start, and no room is replaced or restarted by itself. Worlds then change between two steps.
    [[nodiscard]] virtual bool areCoupled() const { return true; }
    /// Returns the rooms: the storeys first, from the lowest on, then cabins and flights of stairs.
    [[nodiscard]] virtual std::span<const RunRoom> rooms() const = 0;
    /// Returns the room in which a robot or a person is that goes between rooms.
    [[nodiscard]] virtual std::optional<std::size_t> roomOf(std::string_view mover) const = 0;
    /// Returns the keys of a reply that tell where a mover of a room is: "storey=upper", or
    /// "storey=upper in=l1 z=2.100"; "" in the only room.
    [[nodiscard]] virtual std::string whereText(std::size_t room) const = 0;
    [[nodiscard]] virtual RoomFrame frameOf(std::size_t room) const = 0;
    /// Returns the passages that lead from a room to others.
    [[nodiscard]] virtual std::vector<PassageOutline> passageOutlines(std::size_t room) const = 0;

    /// Returns the ways over a storey, from where movers will leave stairs and lifts to the next
    /// ones or to their goals, in the order of the movers' ids. Empty for other rooms.
    [[nodiscard]] virtual std::vector<PlannedPath> plannedPaths(std::size_t room) const = 0;

    /// Sends a mover by the fastest way to the points of a plan. \pre the speed is one that it can
    /// go
    virtual TripAnswer travel(const std::string& mover, TripPlan plan) = 0;
    /// Sends a mover by a lift to its landing on a storey.
    virtual TripAnswer ride(const std::string& mover, std::string_view lift,
                            std::string_view storey) = 0;
    /// Ends a trip, before another command. \returns the reason why that is impossible now, or ""
    virtual std::string endTrip(const std::string& mover, Outcome outcome) = 0;
    /// Ends a trip as stopped; in a lift or on stairs once the mover is out and off the landing.
    virtual void abandonTrip(const std::string& mover) = 0;
    /// Puts a mover, at rest, to a point of a storey, to a heading, or to both; its trip and its
    /// command end as stopped. \returns the reason why that is impossible, or ""
    virtual std::string place(const std::string& mover, const std::optional<RoomPoint>& at,
                              std::optional<Angle> heading) = 0;
    /// Restarts all rooms and lifts as at the start of the run; time goes on. Trips and commands
    /// under way end as stopped, and trips of records begin anew.
    virtual void restart() = 0;
    /// Calls a lift. \returns the reason why it does not come, or ""
    virtual std::string call(std::string_view lift, std::string_view storey) = 0;
    /// Holds the doors of a lift open at a storey, to which it goes before all calls; "" ends that.
    /// \returns the reason why it does not come, or ""
    virtual std::string hold(std::string_view lift, std::string_view storey) = 0;
    [[nodiscard]] virtual std::vector<LiftState> lifts() const = 0;
    /// Returns the trips that ended before or in the last step, in order.
    [[nodiscard]] virtual std::span<const TripEnd> tripEnds() const = 0;

    /// Sets an observer of movers that have gone to another room, called between steps.
    using Observer =
        std::function<void(const std::string& mover, std::size_t from, std::size_t to)>;
    virtual void onMove(Observer observer) = 0;
};

}  // namespace ispace
