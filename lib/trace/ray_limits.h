// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace ispace {

/// The range of a ray that meets nothing.
constexpr float kNoReturn = std::numeric_limits<float>::infinity();

/// Slack for rounding at the far end of a ray, or about a body, relative to the distance.
constexpr double kFarSlack = 1e-6;

}  // namespace ispace
