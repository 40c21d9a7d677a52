// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom only: what planar_map and boolean have in common, so that one source compiles
// the exact kernel.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// The bounded faces of the arrangement of lines and passages. Faces on both sides of a passage are
/// one, if both are bounded and no line lies on it. Segments of no length are ignored, as are those
/// that bound nothing. Sorted; curves begin at their lowest vertex.
std::vector<Region> overlayFaces(std::span<const Segment2> lines,
                                 std::span<const Segment2> passages = {});

/// The same by a walk along the lines, without an arrangement and much faster; nothing if segments
/// meet elsewhere than at common ends, or if it takes too long to find out.
std::optional<std::vector<Region>> tracedFaces(std::span<const Segment2> lines,
                                               std::span<const Segment2> passages = {});

/// The open connected pieces where the winding number of `added` is positive and that of `removed`
/// is zero. Sorted; curves begin at their lowest vertex.
///
/// Winding numbers instead of polygon sets: curves may touch, overlap and repeat as they like.
/// \throws FormatError (without a place) for lines that cross by the million
std::vector<Region> overlayDifference(std::span<const Segment2> added,
                                      std::span<const Segment2> removed);

/// Lets the curve begin at its lowest vertex, at that of its visits with the lower successor.
void rotateToLowest(Polygon& curve);

/// Drops regions without outline; sorts the others and the holes of each.
void putInOrder(std::vector<Region>& regions);

}  // namespace ispace
