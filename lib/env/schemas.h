// SPDX-License-Identifier: GPL-3.0-or-later
// lib/env: the environment: its records, bodies, indoor region, slices, mesh. Uses record, geom.
#pragma once

#include <vector>

#include "record/schema.h"

namespace ispace {

/// Height of walls and fences that say nothing else, in metres.
constexpr double kWallHeight = 2.5;

/// ispace, inside, zone, floor, wall, fence, pillar, table, desk, chair, barrier, cube, cylinder.
std::vector<Schema> environmentSchemas();

}  // namespace ispace
