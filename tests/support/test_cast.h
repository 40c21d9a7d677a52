// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "env/environment.h"
#include "geom/point.h"
#include "trace/ray_world.h"
#include "trace/rays.h"

namespace ispace::testing {

/// Returns the distance to the first surface along a vector, up to 100 m.
inline double castTo(const Environment& room, Point3 from, Vec3 way) {
    Directions directions;
    directions.resize(1);
    directions.set(0, 1 / length(way) * way);
    std::array<float, 1> range{};
    RayWorld::ofEnvironment(room).cast(from, directions, 100, range);
    return static_cast<double>(range[0]);
}

}  // namespace ispace::testing
