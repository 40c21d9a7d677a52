// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim: from one scene to the next while a world runs.
#pragma once

#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "geom/pose.h"
#include "layout/scene.h"

namespace ispace {

/// Ids of what goes on as it is when `next` follows `before`: robots and people in both whose
/// records say the same of where they are, and sensors, mats and the like whose records are the
/// same. The scene before must outlive them.
std::unordered_set<std::string_view> stayersOf(const Scene& before, const Scene& next);

/// Puts the robots and people who stay, and the sensors they carry, where they are now. Their
/// records still say where they began. \pre `places` has them
void keepInPlace(Scene& next, const std::unordered_set<std::string_view>& stayers,
                 const std::unordered_map<std::string_view, Pose2>& places);

}  // namespace ispace
