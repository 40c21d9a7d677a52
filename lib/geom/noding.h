// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom, and for plans: the one way to cut lines where they meet.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// A line or a piece of one: of which, and what it parts. Where several lie upon each other it
/// stands for all of them.
struct LinePiece {
    Segment2 segment;
    std::uint32_t line = 0;  ///< the first of its lines
    /// Winding numbers on its left less those on its right, summed over its lines.
    std::int32_t added = 0, removed = 0;
    bool is_passage = false;  ///< all of its lines are passages: it parts nothing
};
/// Numbered in order.
std::vector<LinePiece> linePieces(std::span<const Segment2> lines);

/// Crossings that lines may have, about: some gigabytes.
constexpr double kMaxCrossings = 500'000;

/// What noded() says of lines that cross too often.
struct CrossingMessage {
    std::string what = "lines", hint = "end them where they meet";
};

/// The lines cut where they cross, touch or overlap, each piece once: they meet in common end
/// points alone, exactly. Lines of no length are dropped. Sorted by place, in an order that depends
/// only on the input.
///
/// End points of lines stay the doubles they are, crossings are rounded to the nearest. Points
/// nearer than some 64 units in the last place of the largest coordinate are one (the first), and
/// lines as near to a point run through it: so far do crossings round. That is iterated snap
/// rounding (Halperin and Packer, 2002) on doubles. On the lattice of Overlay a wall would move by
/// up to 1e-7 m in a plan of 100 m, and areas of rooms by 1e-7 of them; here by 1e-13, so that the
/// areas of faces and differences are as right as those of an exact arrangement.
/// O((n + crossings) log n) for lines that are short or sparse.
/// \throws FormatError (without a place) for lines that cross, or lie upon each other, by the
/// million: "WHAT cross each other about N times, at most … can be; HINT"
std::vector<LinePiece> noded(std::vector<LinePiece> lines, const CrossingMessage& message = {});

/// About how many pairs of the lines have a point in common, by a sample of them where there are
/// many; 0 where too few of the sample do.
double sampledCrossings(std::span<const Segment2> lines);

}  // namespace ispace
