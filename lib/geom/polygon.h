// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/box.h"
#include "geom/point.h"

namespace ispace {

struct Segment2 {
    Point2 a, b;
    friend bool operator==(const Segment2&, const Segment2&) = default;
};

/// Where a point lies with respect to a closed curve; decided exactly.
enum class Side { Inside, Boundary, Outside };

/// A closed curve of straight edges; the last vertex joins the first.
using Polygon = std::vector<Point2>;

/// Signed area, positive if counter-clockwise.
double signedArea(const Polygon& polygon);
double perimeter(const Polygon& polygon);
Box2 bounds(const Polygon& polygon);
Box2 bounds(const Segment2& segment);
/// True if every corner of a polygon that does not cross itself turns left or goes straight on, and
/// one turns: counter-clockwise, with an area; vertices may lie along edges and be doubled. Exact.
/// O(n)
bool isConvex(const Polygon& polygon);
/// The same without corners that go straight on: then a fan from any vertex triangulates it. O(n)
bool isStrictlyConvex(const Polygon& polygon);
/// Even-odd rule, exact (robust orientation of the given doubles). O(n).
Side locate(const Polygon& polygon, Point2 p);

/// A connected piece of the floor: an outline (counter-clockwise) less its holes (clockwise).
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

/// Pieces of the floor that share no inside: they may share edges, and one may lie in a hole of
/// another.
struct Regions {
    std::vector<Region> parts;

    [[nodiscard]] double area() const;
    /// Of all parts: an edge between two counts for both.
    [[nodiscard]] double boundaryLength() const;
    /// On the boundary of a part it is Boundary, also between two.
    [[nodiscard]] Side locate(Point2 p) const;
    /// Calls visit(Segment2) for each edge of each part.
    template <typename Visit>
    void forEachEdge(Visit visit) const;
    friend bool operator==(const Regions&, const Regions&) = default;
};
Box2 bounds(const Regions& regions);

/// The outline and then the holes, of one region or of several one after another: by the even-odd
/// rule the same area, where regions are disjoint.
std::vector<Polygon> curvesOf(const Region& region);
std::vector<Polygon> curvesOf(const std::vector<Region>& regions);
std::vector<Polygon> curvesOf(const Regions& regions);

/// A point strictly inside the region, well away from its boundary where it can be.
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

}  // namespace ispace
