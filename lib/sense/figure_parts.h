// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sense: what its pictures share.
#pragma once

#include <string>
#include <string_view>

#include "geom/pose.h"

namespace ispace {

/// `id (model), frame k`, and the tilt and roll if there are.
std::string figureTitle(std::string_view id, std::string_view model, std::string_view kind,
                        int frame, const Pose3& pose);

/// A round number of metres with its unit: "0.25 m".
std::string metres(double value);

/// To a tenth, with a minus sign as it is printed: "−7.5°".
std::string degrees(Angle angle);

}  // namespace ispace
