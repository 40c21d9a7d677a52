// SPDX-License-Identifier: GPL-3.0-or-later
// Lines cut where they meet, for SightMesh; private to it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// A piece of a line, and which one.
struct LinePiece {
    Segment2 segment;
    std::uint32_t line = 0;
};

/// The lines cut where they cross, touch or overlap, each piece once (with the first of its lines):
/// they meet in common end points alone. Lines of no length are dropped.
///
/// Points nearer than some 64 units in the last place of the largest coordinate are one, and lines
/// as near to a point run through it: so far do crossings round. CGAL's constrained triangulation
/// moves a line to a far vertex when a crossing rounds to the wrong side of another line.
/// O((n + crossings) log n) for lines that are short or sparse.
/// \throws FormatError (without a place) for lines that cross, or lie upon each other, by the
/// million
std::vector<LinePiece> piecesOf(std::span<const Segment2> lines);

}  // namespace ispace
