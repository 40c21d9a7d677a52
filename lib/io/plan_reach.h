// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// The floor that a disc covers which moves from `start` without crossing a wall: the pieces of
/// `rooms` that it sweeps. Corners of rooms are rounded accordingly; the radius is met
/// up to 1 %. Empty where the disc does not fit at `start`.
/// \param walls what the disc must not cross, among them the rooms' boundaries; doors left out
std::vector<Region> reachedFloor(std::span<const Region> rooms, std::span<const Segment2> walls,
                                 Point2 start, double radius);

/// The lines without the parts on which a passage lies, as doors lie on walls.
std::vector<Segment2> withoutPassages(std::span<const Segment2> lines,
                                      std::span<const Segment2> passages);

}  // namespace ispace
