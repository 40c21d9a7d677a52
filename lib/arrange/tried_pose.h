// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "geom/pose.h"

namespace ispace {

/// A pose that a search for an arrangement tried for a sensor, and what it would cover.
struct TriedPose {
    std::string sensor;  ///< id; of several that are alike the first
    Pose3 pose;
    double value = 0;  ///< share of what counts that it would add to what stands already
    bool is_chosen = false;
    std::optional<double> slice_area = {};  ///< of a laser, eq. (4.4), m2
};

}  // namespace ispace
