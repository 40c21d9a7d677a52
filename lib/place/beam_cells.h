// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/cell_set.h"
#include "raster/grid.h"
#include "sensor/sensor.h"
#include "trace/ray_world.h"

namespace ispace {

/// The laser as a search scans with it at the thesis' "reso" (section 4.2): one scan of all it
/// sweeps, with beams `step` apart from its first one on; 0: its own step. Where it sees all around
/// the nearest step that divides a turn. \pre 0 <= step <= 90 degrees
Laser atResolution(Laser laser, Angle step);

/// The cells within the contour of a scan: centres strictly inside the polygon of the place and the
/// ends of all beams, at the first surface or else at max_range (section 4.5.2). If the beams close
/// the circle, of the ends alone. \pre the sensor is a laser
CellSet cellsByBeams(const Grid& grid, const RayWorld& world, const Sensor& sensor);

}  // namespace ispace
