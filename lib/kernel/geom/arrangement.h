// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/kernel/geom: cuts lines where they meet (noding.cc), finds the faces between them
// (plane_graph.h), and builds regions of faces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// A line or a piece of one. Overlapping lines share one piece.
struct LinePiece {
    Segment2 segment;
    std::uint32_t line = 0;  ///< index of the first of its lines
    /// Sum over its lines of the winding number on the left less that on the right.
    std::int32_t added = 0, removed = 0;
    bool is_passage = false;  ///< all of its lines are passages, so it separates no faces
};
/// Returns the lines as whole pieces, numbered in order.
std::vector<LinePiece> linePieces(std::span<const Segment2> lines);

/// Approximate limit on crossings; that many take some gigabytes.
constexpr double kMaxCrossings = 500'000;

/// Texts of the error about lines that cross too often.
struct CrossingMessage {
    std::string what = "lines", hint = "end them where they meet";
};

/// Cuts lines where they cross, touch or overlap: pieces meet at common end points only, exactly,
/// without duplicates. Lines of zero length are dropped. Sorted by position.
///
/// This is iterated snap rounding (Halperin and Packer, 2002) on doubles. End points keep their
/// doubles and crossings are rounded; points within 64 ulp of the largest coordinate are merged
/// (into the first), and lines that pass this close to a point are routed through it. Overlay
/// rounds to a lattice instead, which in a plan of 100 m would move walls by 1e-7 m and change
/// areas of rooms by 1e-7 of their value. Here it is 1e-13, so faces and differences have the areas
/// of an exact arrangement (arrangement_test compares them with CGAL's). O((n + crossings) log n)
/// for lines that are short or sparse. \throws FormatError (without a line number) for lines that
/// cross or overlap by the million: "WHAT cross each other about N times, at most … can be; HINT"
std::vector<LinePiece> noded(std::vector<LinePiece> lines, const CrossingMessage& message = {});

/// Estimates the number of intersecting pairs of lines from a sample; 0 if the sample has too few.
double sampledCrossings(std::span<const Segment2> lines);

/// Finds the bounded faces of the arrangement of lines; the faces on the two sides of a passage are
/// one if both are bounded. Dangling segments are ignored. Sorted; curves begin at their lowest
/// vertex. \throws FormatError (without a line number) as noded() does
std::vector<Region> facesOf(std::vector<LinePiece> lines, const CrossingMessage& message);

/// Returns the open connected pieces where the winding number `added` is positive and `removed` is
/// zero. With winding numbers curves may touch, overlap and repeat. Sorted; curves begin at their
/// lowest vertex. \throws FormatError (without a line number) as noded() does
std::vector<Region> differenceOf(std::vector<LinePiece> lines, const CrossingMessage& message);

/// Rotates the curve so that it begins at its lowest vertex; if it visits that more than once, at
/// the visit with the lower successor.
void rotateToLowest(Polygon& curve);

/// Removes regions without an outline; sorts the others, and the holes of each.
void putInOrder(std::vector<Region>& regions);

/// Finds the connected pieces of `region` outside all closed `solids`, which are simple polygons of
/// either orientation and may overlap and touch. Only crossings are rounded, to doubles.
/// \throws FormatError (without a line number) for outlines that cross each other by the million
std::vector<Region> difference(const Region& region, std::span<const Polygon> solids);

/// Subtracts the solids from each part.
std::vector<Region> difference(const Regions& regions, std::span<const Polygon> solids);

/// Computes the union of closed `solids`, as in difference().
std::vector<Region> unite(std::span<const Polygon> solids);

/// Computes the sum of the areas of disjoint regions.
double totalArea(std::span<const Region> regions);

// Convex polygons, in time linear in their vertices: round tables have tens of thousands.

/// Support function of a convex polygon, for a sequence of directions. Each query searches from the
/// last answer: O(1) on average if the directions turn steadily, O(n) if they jump.
class Caliper {
  public:
    /// Stores a view of the vertices. \pre at least one
    explicit Caliper(std::span<const Point2> corners) : corners_(corners) {}
    /// Returns the largest dot product of a vertex (from the origin) and a unit vector.
    double reach(Vec2 direction);

  private:
    std::span<const Point2> corners_;
    std::size_t at_ = 0;
    Vec2 last_;
};

/// Computes the intersection of two counter-clockwise convex polygons; empty if they share no area.
/// O(n + m)
Polygon sharedByConvex(const Polygon& a, const Polygon& b);

}  // namespace ispace
