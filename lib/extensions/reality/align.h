// SPDX-License-Identifier: GPL-3.0-or-later
// Aligns the poses of a log to the plan.
#pragma once

#include <cstddef>
#include <vector>

#include "extensions/reality/compare.h"

namespace ispace::reality {

/// Corrections of poses: of the whole log, and then of each scan (of each sensor that stands still,
/// from all its scans). A scan that too few beams support keeps its pose.
struct Alignment {
    Pose2 whole;               ///< plan_from_log
    std::vector<Pose2> moved;  ///< of each scan after that: the change of position, and of heading
    std::size_t kept = 0;      ///< scans that keep their pose
    /// Medians and greatest corrections of single scans.
    double median_metres = 0, most_metres = 0;
    Angle median_turn, most_turn;
};

/// Moves the poses of the run so that the simulated ranges fit the measured ones best: by
/// Levenberg and Marquardt (Eigen) through the simulation, with the robust loss of Cauchy, whose
/// width shrinks from half a metre to 10 cm. Heights, tilt and roll stay.
/// \pre simulate() prepared the worlds for the run
Alignment align(LoggedRun& run, const RayScenes& worlds);

}  // namespace ispace::reality
