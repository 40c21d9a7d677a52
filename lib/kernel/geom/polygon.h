// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/point.h"

namespace ispace {

struct Segment2 {
    Point2 a, b;
    friend bool operator==(const Segment2&, const Segment2&) = default;
};

/// Position of a point relative to a closed curve; decided exactly.
enum class Side { Inside, Boundary, Outside };

/// A closed curve of straight edges; the last vertex joins the first.
using Polygon = std::vector<Point2>;

/// Computes the signed area, positive if counter-clockwise.
double signedArea(const Polygon& polygon);
double perimeter(const Polygon& polygon);
Box2 bounds(const Polygon& polygon);
Box2 bounds(const Segment2& segment);
/// True if a simple polygon is convex, counter-clockwise and has an area; collinear and repeated
/// vertices are allowed. Exact. O(n)
bool isConvex(const Polygon& polygon);
/// Removes collinear vertices: a fan from any vertex then triangulates the polygon. O(n)
bool isStrictlyConvex(const Polygon& polygon);
/// Locates a point by the even-odd rule; exact (robust orientation of the given doubles). O(n).
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
/// touch.
Triangulation triangulate(const Region& region);

/// Simplifies closed curves (CGAL's Polyline_simplification_2): no curve moves by more than
/// `tolerance` metres, separate curves stay separate, and every curve remains. Vertices where
/// curves touch and those in `kept` stay. Result i belongs to curve i.
std::vector<Polygon> simplified(const std::vector<Polygon>& curves, double tolerance,
                                std::vector<Point2> kept = {});

}  // namespace ispace
