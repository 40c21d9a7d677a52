// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "base/cell_set.h"
#include "raster/grid.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/sensor.h"
#include "trace/ray_world.h"

namespace ispace {

/// The cells that a sensor which does not scan a level slice sees of the plane at `height`, tested
/// one by one: the centre is in view, its edges included, and in range, and a ray of float32 (see
/// RayWorld::query) meets nothing of the mesh on its way there. A mesh of Solid surfaces for
/// receivers, of Opaque ones for all others.
///
/// These are the centres in ShadowCaster::regionSeen(), but for those within 0.3 mm of its
/// boundary. A swept laser, of which no region is known, sees what its scans pass as it turns on,
/// between scans as well.
CellSet cellsOnPlane(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, double height);

/// The same for fields of view at one place that differ in the direction in which they face alone:
/// part k of `parts` is what view k sees. O(cells in reach * views + rays)
void cellsByView(const Grid& grid, const RayWorld& mesh, std::span<const FieldOfView> views,
                 double height, CellParts& parts);

}  // namespace ispace
