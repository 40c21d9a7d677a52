// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "layout/scene.h"
#include "raster/grid.h"
#include "solve/problem.h"

namespace ispace {

/// Upper bound of the cells of the grid that one such sensor sees of a level plane, wherever it
/// stands and whichever way it faces: the area within d, half a cell's diagonal, of what may be in
/// view, over the area of a cell. For a connected part of the plane with area A and outline L that
/// is at most A + L d + pi d^2 (Steiner's formula). A and L are at most those
/// - of its sector for a laser that does not sweep; a tilted or rolled one covers no more, as its
///   sector is seen from above, where nothing is longer or larger;
/// - of the disc of its range for swept lasers, receivers and spherical rangers: nothing they see
/// of
///   a plane is farther away;
/// - for pinholes of any plane section of the view pyramid down to the depth of the range, and of
///   the disc through the farthest point in view, which for those that measure depth is a corner of
///   the picture, beyond the range. The area of a section is the root of the sum of squares of the
///   areas of its three projections, here at most the rectangle and two triangles of the pyramid;
///   its outline, as of any convex figure, is at most pi times its diameter.
std::uint64_t maxCellsInView(const SensorModel& device, const Grid& grid);

/// Upper bound of the value of sensors at any places, on the grid of the problem's weights: what
/// stands already covers, and the heaviest other cells, as many as these sensors can see together.
/// `devices` are those of the problem's kinds, `most` the maximum number of each; with a budget
/// those that see most per cost count, the last one in part.
std::uint64_t maxFromAnyPlace(const Problem& problem, const Grid& grid,
                              std::span<const SensorModel> devices, std::span<const int> most);

}  // namespace ispace
