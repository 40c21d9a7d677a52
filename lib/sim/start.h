// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <span>

#include "layout/scene.h"
#include "sim/collision.h"
#include "sim/people.h"

namespace ispace {

/// What robots run into, by their heights.
using ObstacleSets = std::map<double, Obstacles>;
ObstacleSets obstaclesOf(const Scene& scene);

/// \throws FormatError with all findings if a robot stands in something, in another robot or in
///         somebody
void checkStart(const Scene& scene, std::span<const Person> people, const ObstacleSets& obstacles);

}  // namespace ispace
