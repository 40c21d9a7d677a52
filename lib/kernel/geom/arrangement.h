// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts lines where they meet (noding.cc), finds the faces between them (plane_graph.h), and builds
// regions of faces: bounded faces, differences and unions of polygons (boolean.cc).
//
// Guarantees. End points of the input keep their doubles unless they nearly coincide; crossings are
// rounded to doubles; decisions of side are exact. Lines may cross, overlap, repeat, dangle and
// have zero length. The result depends on the lines and their order alone. Pure functions:
// thread-safe.
//
// Costs: O((n + crossings) log n) time for lines that are short or sparse, O(n + crossings) memory;
// lines with many more than kMaxCrossings are refused by FormatError.
//
//     const Region room{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}};
//     const Polygon table{{1, 1}, {2, 1}, {2, 2}, {1, 2}};
//     const std::vector<Region> free = difference(room, {{table}});  // one region, one hole: 11 m2
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
/// This is iterated snap rounding (D. Halperin, E. Packer, Iterated snap rounding, 2002) on
/// doubles. End points keep their doubles and crossings are rounded; points within 64 ulp of the
/// largest coordinate (2^-46 of it, 1.4e-12 m in a plan of 100 m) are merged (into the first), and
/// lines that pass this close to a point are routed through it. Rounds of cutting repeat until no
/// line is cut, at most 12 times; if that does not suffice the distance grows by 64, at most three
/// times. Overlay rounds to a lattice instead, which in a plan of 100 m would move walls by 1e-7 m
/// and change areas of rooms by 1e-7 of their value. Here it is 1e-13, so faces and differences
/// have the areas of an exact arrangement (arrangement_test compares them with CGAL's). O((n +
/// crossings) log n) for lines that are short or sparse. \throws FormatError (without a line
/// number) for lines that cross or overlap by the million: "WHAT cross each other about N times, at
/// most … can be; HINT"
std::vector<LinePiece> noded(std::vector<LinePiece> lines, const CrossingMessage& message = {});

/// Estimates the number of intersecting pairs of lines, ends that touch included: counts all pairs
/// of up to some 500 lines, else 2^17 to 2^22 random pairs by a fixed seed; 0 for fewer than 16
/// hits among these. With h hits the standard error is 1 / sqrt(h) of the estimate.
double sampledCrossings(std::span<const Segment2> lines);

/// Finds the bounded faces of the arrangement of lines; the faces on the two sides of a passage are
/// one if both are bounded. Dangling segments are ignored. Regions and holes are sorted by their
/// vertices; curves begin at their lowest vertex, outlines run counter-clockwise, holes clockwise.
/// Faces without area in doubles are dropped. \throws FormatError (without a line number) as
/// noded() does
std::vector<Region> facesOf(std::vector<LinePiece> lines, const CrossingMessage& message);

/// Returns the open connected pieces where the winding number `added` is positive and `removed` is
/// zero. With winding numbers curves may touch, overlap and repeat. Sorted; curves begin at their
/// lowest vertex. Pieces that touch at a point alone are separate regions. \throws FormatError
/// (without a line number) as noded() does
std::vector<Region> differenceOf(std::vector<LinePiece> lines, const CrossingMessage& message);

/// Rotates the curve so that it begins at its lowest vertex; if it visits that more than once, at
/// the visit with the lower successor.
void rotateToLowest(Polygon& curve);

/// Removes regions without an outline; sorts the others, and the holes of each.
void putInOrder(std::vector<Region>& regions);

/// Finds the connected pieces of `region` outside all closed `solids`, which are simple polygons of
/// either orientation and may overlap and touch. Only crossings are rounded, to doubles: areas err
/// by some 1e-13 of their value in a plan of 100 m. A solid whose box meets neither a wall nor
/// another solid's box becomes a hole without noding, clockwise, with its vertices. Pieces are
/// sorted; the holes of such solids follow the others, in the order of the solids.
/// \throws FormatError (without a line number) for outlines that cross each other by the million
std::vector<Region> difference(const Region& region, std::span<const Polygon> solids);

/// Subtracts the solids from each part, in the order of the parts.
std::vector<Region> difference(const Regions& regions, std::span<const Polygon> solids);

/// Computes the interior of the union of closed `solids`, as in difference(): parts that touch at a
/// point alone are separate regions, and an area enclosed by solids is a hole.
std::vector<Region> unite(std::span<const Polygon> solids);

/// Computes the sum of the areas of disjoint regions, m2.
double totalArea(std::span<const Region> regions);

// Convex polygons, in time linear in their vertices: round tables have tens of thousands.

/// Support function of a convex polygon, for a sequence of directions. Each query searches from the
/// last answer: O(1) on average if the directions turn steadily, O(n) if they jump by more than
/// 45 degrees (G. T. Toussaint, Solving geometric problems with the rotating calipers, 1983). Not
/// thread-safe: a query changes its start.
///
///     Caliper caliper(corners);
///     const double width = caliper.reach({1, 0}) + caliper.reach({-1, 0});
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
/// Cuts a by the edges of b (I. E. Sutherland, G. W. Hodgman, Reentrant polygon clipping, 1974),
/// each from the vertex where the last cut ended, since both turn once around: O(n + m). Cuts
/// round; a shared sliver of rounding width may be kept or lost.
Polygon sharedByConvex(const Polygon& a, const Polygon& b);

}  // namespace ispace
