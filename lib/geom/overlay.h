// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom only: what planar_map and boolean have in common, so that one source compiles
// the exact kernel.
#pragma once

#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// Each bounded face of the arrangement of the segments by itself. Those of no length are ignored,
/// as are those that bound nothing. Sorted; curves begin at their lowest vertex.
std::vector<Region> overlayFaces(std::span<const Segment2> segments);

/// The open connected pieces where the winding number of `added` is positive and that of `removed`
/// is zero. Sorted; curves begin at their lowest vertex.
///
/// Winding numbers instead of polygon sets: curves may touch, overlap and repeat as they like.
std::vector<Region> overlayDifference(std::span<const Segment2> added,
                                      std::span<const Segment2> removed);

}  // namespace ispace
