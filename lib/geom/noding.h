// SPDX-License-Identifier: GPL-3.0-or-later
// Noding: cutting lines where they meet.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// A line or a piece of one. A piece on which several lines lie stands for all of them.
struct LinePiece {
    Segment2 segment;
    std::uint32_t line = 0;  ///< the first of its lines
    /// Winding numbers on its left less those on its right, summed over its lines.
    std::int32_t added = 0, removed = 0;
    bool is_passage = false;  ///< all of its lines are passages: it separates nothing
};
/// Numbered in order.
std::vector<LinePiece> linePieces(std::span<const Segment2> lines);

/// About how many crossings are allowed; they take some gigabytes.
constexpr double kMaxCrossings = 500'000;

/// What noded() reports about lines that cross too often.
struct CrossingMessage {
    std::string what = "lines", hint = "end them where they meet";
};

/// The lines cut where they cross, touch or overlap: the pieces meet at common end points only,
/// exactly, and each is there once. Lines of zero length are dropped. Sorted by position.
///
/// This is iterated snap rounding (Halperin and Packer, 2002) on doubles. End points keep their
/// doubles and crossings are rounded; points within 64 units in the last place of the largest
/// coordinate are merged (into the first), and lines that pass a point this closely are led through
/// it. Overlay rounds to a lattice instead, which in a plan of 100 m would move walls by 1e-7 m and
/// change areas of rooms by 1e-7 of their value. Here it is 1e-13, so faces and differences have
/// the areas of an exact arrangement (arrangement_test compares them with CGAL's). O((n +
/// crossings) log n) for lines that are short or sparse. \throws FormatError (without a place) for
/// lines that cross or overlap by the million: "WHAT cross each other about N times, at most … can
/// be; HINT"
std::vector<LinePiece> noded(std::vector<LinePiece> lines, const CrossingMessage& message = {});

/// Estimates how many pairs of lines intersect, from a sample; 0 if too few of the sample do.
double sampledCrossings(std::span<const Segment2> lines);

}  // namespace ispace
