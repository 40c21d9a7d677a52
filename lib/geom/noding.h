// SPDX-License-Identifier: GPL-3.0-or-later
// Lines cut where they meet, and a bound on how often they may.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/planar_map.h"
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

/// The lines cut where they cross each other, crossings rounded to doubles: the pieces of a line in
/// its order, with its index. Where lines cross more than some twenty times each on average they
/// stay whole. Pieces meet at common ends but for rounding, which weld() takes care of.
WeldedLines cutAtCrossings(std::span<const Segment2> lines);

/// Crossings that an arrangement may have, about: some gigabytes.
constexpr double kMaxCrossings = 500'000;

/// About how many pairs of the lines have a point in common, by a sample of them where there are
/// many; 0 where too few of the sample do.
double sampledCrossings(std::span<const Segment2> lines);

/// \throws FormatError (without a place) if the lines cross more than kMaxCrossings times: "WHAT
/// cross each other about N times, at most … can be; HINT"
void mustCrossRarely(std::span<const Segment2> lines, const std::string& what,
                     const std::string& hint);

}  // namespace ispace
