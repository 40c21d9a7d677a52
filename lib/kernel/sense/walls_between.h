// SPDX-License-Identifier: GPL-3.0-or-later
// The walls that sound and radio pass: each takes its loss from a signal. Thread-safe; a ray for
// each wall.
//
//     const double level = volume - wallsBetween(speaker, microphone, mesh) * loss;  // dB
#pragma once

#include "geom/point.h"
#include "trace/ray_world.h"

namespace ispace {

/// Counts the surfaces between two points, at most 100. Surfaces less than half a metre apart count
/// as one wall.
/// \param mesh not a slice
int wallsBetween(Point3 from, Point3 to, const RayWorld& mesh);

}  // namespace ispace
