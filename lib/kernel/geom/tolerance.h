// SPDX-License-Identifier: GPL-3.0-or-later
// The tolerances, each with its reason: bounds of the rounding errors of equal values. Constants
// that belong to one algorithm, such as its largest step, stand beside it.
//
// A tolerance decides whether two computed values are the same value. It never decides a side:
// left, right and collinear are those of orientation() in predicates.h.
#pragma once

namespace ispace {

// Positions, in metres.

/// Rounding of coordinates computed in two ways in a room of some kilometres: circles, bodies and
/// chords this near touch, or coincide.
inline constexpr double kContactTolerance = 1e-9;

/// Files and layouts give corners to the micrometre: those this near are one, and walls or things
/// that overlap by less lie side by side.
inline constexpr double kCornerTolerance = 1e-6;

// Numbers without unit.

/// Rounding of unit vectors, cosines and sines.
inline constexpr double kUnitTolerance = 1e-12;
/// Components across its axis that an upright direction of a file may have.
inline constexpr double kUprightTolerance = 1e-6;
/// Rounding of distances to float32, as a share, with some of its own.
inline constexpr double kFloatTolerance = 1e-6;
/// Quotients of decimals such as 0.3 / 0.1, counted in whole steps.
inline constexpr double kStepTolerance = 1e-9;

// Seconds.

/// Moments of a run are whole nanoseconds: those less than one apart are the same.
inline constexpr double kTimeTolerance = 1e-9;

}  // namespace ispace
