// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/sim: the simulated world, its commands, clock and records. Uses sense and below; TBB
// inside.
//
// world.h has the world of one room, step by step; simulation.h drives it by a clock, a script or a
// record; recorder.h writes records; worlds.h is the interface of one room or many to the server.
//
// Time is a whole number of nanoseconds: sums of steps, periods of sensors and times of events are
// exact, and a run of a hundred years ends at the same nanosecond on every machine. Texts
// round-trip: digits are read one by one, since a double does not hold every nanosecond.
//
//     const std::optional<SimTime> step = parseSimTime("5ms");
//     const std::string text = formatSimTime(1001 * *step);         // "5.005"
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace ispace {

/// Simulated time, a whole number of nanoseconds from the start of the run.
using SimTime = std::chrono::nanoseconds;

/// Runs end at this time at the latest: a hundred years.
constexpr SimTime kMaxTime = std::chrono::hours(24) * 36525;

/// Returns the nearest double, for formats that store seconds as a number.
double seconds(SimTime time);

/// Rounds to nanoseconds. \pre |seconds| is below a hundred years
SimTime simSeconds(double seconds);

/// Parses "2.5", "5ms", "2min": units of Unit::Time, seconds without one, rounded to nanoseconds,
/// half up. Returns nullopt if it is not a number, negative, or above a hundred years.
std::optional<SimTime> parseSimTime(std::string_view text);

/// Returns the exact and shortest text, in seconds: "0.005".
std::string formatSimTime(SimTime time);

/// Returns seconds with three decimals, as the protocol requires: "12.300".
std::string formatMilliseconds(SimTime time);

}  // namespace ispace
