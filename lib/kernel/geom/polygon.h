// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons, regions with holes, and sets of regions: areas, exact point location, interior points,
// triangulation and simplification.
//
// Points are located exactly, by the orientation of the doubles given; areas and lengths round.
// Curves may touch themselves and each other at points; degenerate curves (fewer than three
// vertices, no area) have area 0 and contain no inner point. Pure functions, O(n) unless stated;
// for many point queries use RegionIndex of env/point_location.h.
//
//     const Region ring{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{{1, 1}, {1, 3}, {3, 3}, {3, 1}}}};
//     ring.area();            // 12 m2
//     ring.locate({2, 2});    // Side::Outside: in the hole
//     ring.locate({4, 2});    // Side::Boundary
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/point.h"

namespace ispace {

/// A closed straight segment on the floor; a == b is a point.
struct Segment2 {
    Point2 a, b;
    friend bool operator==(const Segment2&, const Segment2&) = default;
};

/// Position of a point relative to a closed curve; decided exactly.
enum class Side { Inside, Boundary, Outside };

/// A closed curve of straight edges; the last vertex joins the first.
using Polygon = std::vector<Point2>;

/// Computes the signed area, m2, positive if counter-clockwise; relative to the first vertex, so
/// that a small polygon far from the origin keeps its digits.
double signedArea(const Polygon& polygon);
/// Computes the length of all edges, the closing one included, m.
double perimeter(const Polygon& polygon);
/// Returns the bounding box; empty without a vertex. Exact.
Box2 bounds(const Polygon& polygon);
Box2 bounds(const Segment2& segment);
/// True if a simple polygon is convex, counter-clockwise and has an area; collinear and repeated
/// vertices are allowed. Exact. O(n)
bool isConvex(const Polygon& polygon);
/// True if a simple polygon turns left at every vertex, so that a fan from any vertex triangulates
/// it: convex without collinear or repeated vertices. Exact. O(n)
bool isStrictlyConvex(const Polygon& polygon);
/// Locates a point by the even-odd rule: counts the edges that a ray from p towards +x crosses,
/// ends by the half-open rule; exact (robust orientation of the given doubles). The curve may cross
/// itself. Few edges need an orientation: most lie beside the ray by their boxes. O(n)
Side locate(const Polygon& polygon, Point2 p);

/// A connected piece of the floor: an outline (counter-clockwise) minus its holes (clockwise).
/// Curves may touch themselves and each other at single points.
struct Region {
    Polygon outline;
    std::vector<Polygon> holes;

    [[nodiscard]] double area() const;
    /// Length of the outline and of all holes.
    [[nodiscard]] double boundaryLength() const;
    [[nodiscard]] Side locate(Point2 p) const;
    /// Calls visit(Segment2) for each edge, outline first.
    template <typename Visit>
    void forEachEdge(Visit visit) const;
    friend bool operator==(const Region&, const Region&) = default;
};

/// Regions with disjoint interiors: they may share edges, and one may lie in a hole of another.
struct Regions {
    std::vector<Region> parts;

    [[nodiscard]] double area() const;
    /// Sum over all parts: a shared edge counts twice.
    [[nodiscard]] double boundaryLength() const;
    /// Boundary also on an edge between two parts.
    [[nodiscard]] Side locate(Point2 p) const;
    /// Calls visit(Segment2) for each edge of each part.
    template <typename Visit>
    void forEachEdge(Visit visit) const;
    friend bool operator==(const Regions&, const Regions&) = default;
};
Box2 bounds(const Regions& regions);
Box2 bounds(std::span<const Region> regions);
Box2 bounds(std::span<const Polygon> curves);
/// Returns the bounding box of each shape.
template <typename Shapes>
std::vector<Box2> boundsOfEach(const Shapes& shapes) {
    std::vector<Box2> boxes;
    boxes.reserve(shapes.size());
    for (const auto& shape : shapes) boxes.push_back(bounds(shape));
    return boxes;
}

/// Returns the outline and then the holes of each region. If the regions are disjoint, the curves
/// enclose the same area by the even-odd rule.
std::vector<Polygon> curvesOf(const Region& region);
std::vector<Polygon> curvesOf(const std::vector<Region>& regions);
std::vector<Polygon> curvesOf(const Regions& regions);

/// Finds a point strictly inside the region, well away from its boundary if possible.
///
/// Of the middles of the three longest chords on each of some 100 scanlines, level and upright, it
/// returns the one farthest from the boundary; not the pole of inaccessibility. Tested by the exact
/// locate(). In a thin region it tries up to 2 000 scanlines each way, then the centres of the
/// corners' triangles and the doubles next to them. Depends on the region alone; large regions are
/// scanned by two threads. O(n log n) where scanlines cross few edges. \throws
/// std::invalid_argument for a region too thin for a double between its edges
Point2 interiorPoint(const Region& region);

template <typename Visit>
void forEachEdge(const Polygon& polygon, Visit visit) {
    for (std::size_t i = 0; i < polygon.size(); ++i)
        visit(Segment2{polygon[i], polygon[i + 1 == polygon.size() ? 0 : i + 1]});
}

template <typename Visit>
void Region::forEachEdge(Visit visit) const {
    ispace::forEachEdge(outline, visit);
    for (const Polygon& hole : holes) ispace::forEachEdge(hole, visit);
}

template <typename Visit>
void Regions::forEachEdge(Visit visit) const {
    for (const Region& part : parts) part.forEachEdge(visit);
}

/// Triangles over a region's own vertices, counter-clockwise.
struct Triangulation {
    std::vector<Point2> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Computes the constrained Delaunay triangulation of the region's interior (CGAL). Curves may
/// touch; edges that come twice separate no area. Vertices are sorted and distinct, triangles begin
/// at their lowest index and are sorted, so the result depends on the region alone. Edges that
/// cross by a rounding error meet in an added vertex at the end of the list. Without area: no
/// triangles. O(n log n) for usual plans.
Triangulation triangulate(const Region& region);

/// Simplifies closed curves (CGAL's Polyline_simplification_2, after C. Dyken, M. Dæhlen,
/// T. Sevaldrud, Simultaneous curve simplification, 2009): no curve moves by more than `tolerance`
/// metres, separate curves stay separate, and every curve remains. Vertices where curves touch and
/// those in `kept` stay. Result i belongs to curve i, begins at its lowest vertex and, unless
/// curves cross, has a subset of its vertices; a curve of fewer than three vertices or of one point
/// is returned unchanged. No new edge passes another vertex within 2 kWeldDistance, so welding
/// joins none. Removes the cheapest vertex first, ties by position: the result depends on the
/// curves alone.
std::vector<Polygon> simplified(const std::vector<Polygon>& curves, double tolerance,
                                std::vector<Point2> kept = {});

}  // namespace ispace
