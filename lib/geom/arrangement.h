// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom: lines cut where they meet (noding.h), their faces (plane_graph.h), and regions
// made of faces.
#pragma once

#include <vector>

#include "geom/noding.h"

namespace ispace {

/// The bounded faces of the arrangement of lines; the faces on the two sides of a passage are one
/// if both are bounded. Dangling segments are ignored. Sorted; curves begin at their lowest vertex.
/// \throws FormatError (without a place) as noded() does
std::vector<Region> facesOf(std::vector<LinePiece> lines, const CrossingMessage& message);

/// The open connected pieces where the winding number `added` is positive and `removed` is zero.
/// Winding numbers instead of polygon sets: curves may touch, overlap and repeat as they like.
/// Sorted; curves begin at their lowest vertex. \throws FormatError (without a place) as noded()
/// does
std::vector<Region> differenceOf(std::vector<LinePiece> lines, const CrossingMessage& message);

/// Rotates the curve so that it begins at its lowest vertex; if it visits that more than once, at
/// the visit with the lower successor.
void rotateToLowest(Polygon& curve);

/// Drops regions without an outline; sorts the others, and the holes of each.
void putInOrder(std::vector<Region>& regions);

}  // namespace ispace
