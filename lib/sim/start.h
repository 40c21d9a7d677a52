// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>

#include "layout/scene.h"
#include "sim/collision.h"

namespace ispace {

/// What robots run into, by their heights.
using ObstacleSets = std::map<double, Obstacles>;
ObstacleSets obstaclesOf(const Scene& scene);

/// \throws FormatError with all findings if a robot stands in something, or in another robot
void checkStart(const Scene& scene, const ObstacleSets& obstacles);

}  // namespace ispace
