// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom only.
#pragma once

#include "geom/layers_lattice.h"

namespace ispace::lattice {

/// Edges that meet at common ends only, in place of these (which are merged()): each is led through
/// points near it. First through ends of others within the square of half-width 1 about them, so
/// that edges that lay along each other before they were rounded become the same; then through all
/// ends and crossings, rounded to the lattice (snap rounding, Hobby 1999). No place of an edge
/// moves by more than 1.42 and then 0.71 steps. Adds points to the table.
/// \throws FormatError (without a place) for edges that cross by the ten million
std::vector<Edge> snapRounded(std::vector<Edge> edges, PointTable& table, SetStore& sets);

}  // namespace ispace::lattice
