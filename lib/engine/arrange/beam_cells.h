// SPDX-License-Identifier: GPL-3.0-or-later
// Cells that a laser covers by the thesis' reckoning: those within the contour of its beams.
//
// The contour joins the ends of adjacent beams by straight lines: it cuts corners, and holds floor
// behind objects that stand between two beams. Its area is therefore not that of the visible
// region; the thesis' tables are made of it. O(beams) casts, and O(cells of the grid).
#pragma once

#include "base/cell_set.h"
#include "geom/point.h"
#include "raster/grid.h"
#include "scene/sensor/sensor.h"
#include "trace/ray_world.h"

namespace ispace {

/// Returns the laser as a search scans with it at the thesis' "reso" (section 4.2): one scan of its
/// whole sweep, with beams `step` apart from its first beam on; 0: the laser's step. A laser that
/// sees all around gets the nearest step that divides a turn.
/// \pre 0 <= step <= 90 degrees
Laser withBeamStep(Laser laser, Angle step);

/// Returns the cells within the contour of a scan: centres strictly inside the polygon of the
/// sensor's position and the ends of all beams, at the first surface or else at max_range (section
/// 4.5.2). If the beams close the circle, the polygon has the beam ends only.
/// \pre the sensor is a laser
CellSet cellsByBeams(const Grid& grid, const RayWorld& world, const Sensor& sensor);

}  // namespace ispace
