// SPDX-License-Identifier: GPL-3.0-or-later
// Tolerances that several sources share: bounds of the rounding errors of equal values.
#pragma once

namespace ispace {

// Positions, in metres.

/// Rounding of coordinates computed in two ways in a room of some kilometres: circles, bodies and
/// chords this near touch, or coincide.
inline constexpr double kContactTolerance = 1e-9;

// Numbers without unit.

/// Rounding of unit vectors, cosines and sines.
inline constexpr double kUnitTolerance = 1e-12;
/// Quotients of decimals such as 0.3 / 0.1, counted in whole steps.
inline constexpr double kStepTolerance = 1e-9;

// Seconds.

/// Moments of a run are whole nanoseconds: those less than one apart are the same.
inline constexpr double kTimeTolerance = 1e-9;

}  // namespace ispace
