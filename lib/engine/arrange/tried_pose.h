// SPDX-License-Identifier: GPL-3.0-or-later
// Poses that a search tried: rows of --trace, and of the gains that reports show.
#pragma once

#include <optional>
#include <string>

#include "geom/pose.h"

namespace ispace {

/// A pose that a search tried for a sensor, and its coverage.
struct TriedPose {
    std::string sensor;  ///< id; the first of several equal sensors
    Pose3 pose;
    double value = 0;  ///< share of the total weight that it would add to the standing coverage
    bool is_chosen = false;
    std::optional<double> slice_area = {};  ///< of a laser, eq. (4.4), m2
    std::string room = {};                  ///< id of the room; "" of one alone
};

}  // namespace ispace
