// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/sim: the simulated world, its commands, clock and records. Uses sense and below; TBB
// inside.
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

/// Parses "2.5", "5ms", "2min": units of Unit::Time, seconds without one, rounded to nanoseconds.
/// Returns nullopt if it is not a number, negative, or above a hundred years.
std::optional<SimTime> parseSimTime(std::string_view text);

/// Returns the exact and shortest text, in seconds: "0.005".
std::string formatSimTime(SimTime time);

/// Returns seconds with three decimals, as the protocol requires: "12.300".
std::string formatMilliseconds(SimTime time);

}  // namespace ispace
