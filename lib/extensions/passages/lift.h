// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/passages: the worlds of a building in lock step, and the lifts and stairs between
// them. Uses site and sim.
//
// This header has the motion of a lift, as functions of time: height and doors follow from the
// phase and its beginning, so that nothing adds up from step to step, and a record of phases is a
// record of the lift. Durations are rounded to microseconds; a phase begins with the first step at
// or after the end of the one before.
//
//     Lift lift({.floors = {0, 3.2}, .speed = 1});
//     lift.call(1);
//     for (SimTime time{}; !lift.isOpenAt(1); time += step) lift.advance(time, false);
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "sim/sim_time.h"

namespace ispace::passages {

/// A lift as its record describes it.
struct LiftModel {
    std::vector<double> floors;  ///< heights of its stops, ascending, at least two
    double speed = 1;            ///< m/s
    double door = 0.9;           ///< width of its door, metres
};

/// Motion of the cabin and of its doors.
///
/// The lift serves its calls in their order. A ride takes liftRide(); the doors open and close in
/// doorTime(), and stay open for kDwell, or longer while they are held. Each phase begins with a
/// step.
class Lift {
  public:
    /// m/s^2, of the cabin, in both directions; EN 81-20 asks for comfort, and about 1 is usual.
    static constexpr double kAcceleration = 1;
    /// m/s, of each of the two leaves of a door that opens in the middle.
    static constexpr double kLeafSpeed = 0.3;
    static constexpr SimTime kDwell = std::chrono::seconds(3);

    enum class Phase { Waiting, Opening, Open, Closing, Riding };

    /// The state, from which height and doors at a time follow.
    struct State {
        Phase phase = Phase::Waiting;
        std::size_t stop = 0;            ///< at which it is, or from which it rides
        std::size_t next = 0;            ///< to which it rides
        SimTime since{};                 ///< beginning of the phase
        std::vector<std::size_t> calls;  ///< stops, in the order in which it serves them
        friend bool operator==(const State&, const State&) = default;
    };

    /// Stands at the lowest stop, closed.
    explicit Lift(LiftModel model) : model_(std::move(model)) {}

    /// Appends a call, unless this stop is among those to be served. A call from where the lift
    /// stands opens its doors. \pre it is a stop
    void call(std::size_t stop);
    /// Holds the doors open at a stop: it goes there before all calls, and serves none until this
    /// ends or is at another stop. Empty ends it. \pre it is a stop
    void hold(std::optional<std::size_t> stop);
    /// Advances to a time. \param held the doors stay open
    void advance(SimTime time, bool held);

    [[nodiscard]] const State& state() const { return state_; }
    /// Shows a recorded state. advance() must not follow. \pre its stops exist
    void show(State state) { state_ = std::move(state); }
    [[nodiscard]] Phase phase() const { return state_.phase; }
    [[nodiscard]] std::size_t stop() const { return state_.stop; }
    /// Returns true if the doors are open at that stop.
    [[nodiscard]] bool isOpenAt(std::size_t stop) const {
        return state_.phase == Phase::Open && state_.stop == stop;
    }
    [[nodiscard]] const std::vector<std::size_t>& calls() const { return state_.calls; }
    /// Returns the height of its floor at a time, in metres.
    [[nodiscard]] double height(SimTime time) const;
    /// Returns the share of the door's width that is open at a time.
    [[nodiscard]] double opening(SimTime time) const;
    [[nodiscard]] const LiftModel& model() const { return model_; }

  private:
    void begin(Phase phase, SimTime time, SimTime length);

    LiftModel model_;
    State state_;
    SimTime until_{};  // end of the phase
    std::optional<std::size_t> hold_;
};

/// Returns the seconds of a ride over a distance: with constant acceleration to the speed and back,
/// distance / speed + speed / acceleration, or 2 sqrt(distance / acceleration) if the lift does not
/// reach its speed.
double liftRide(double distance, double speed);
/// Returns the distance covered after a time of that ride.
double liftPath(double distance, double speed, double seconds);
/// Returns the seconds in which a door of this width opens, and those in which it closes.
double doorTime(double width);

}  // namespace ispace::passages
