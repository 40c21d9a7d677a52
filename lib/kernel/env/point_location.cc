// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/point_location.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/predicates.h"

namespace ispace {

namespace {

/// Returns the number of cells along one side of a grid with about three cells per edge, within
/// limits that keep building quick.
int cellsAcross(double extent, double other, std::size_t edges) {
    constexpr double kMinCells = 1024, kMaxCells = 250'000, kMaxAcross = 2000;
    const double cells = std::clamp(3 * static_cast<double>(edges), kMinCells, kMaxCells);
    const double across = std::sqrt(cells * extent / other);
    // A box without extent in one direction gets one row.
    return std::isfinite(across) ? static_cast<int>(std::clamp(across, 1.0, kMaxAcross)) : 1;
}

/// Returns a grid that exceeds the box by odd shares: walls are drawn at round numbers, and no
/// centre should lie on one.
Grid gridOver(const Box2& box, std::size_t edges) {
    Grid grid;
    constexpr double kBelow = 0.00317, kAbove = 0.00529;
    const double reach = std::max({box.width(), box.depth(), 1e-6});
    grid.limits = {box.low - Vec2{kBelow * reach, kBelow * reach},
                   box.high + Vec2{kAbove * reach, kAbove * reach}};
    grid.columns = cellsAcross(grid.limits.width(), grid.limits.depth(), edges);
    grid.rows = cellsAcross(grid.limits.depth(), grid.limits.width(), edges);
    return grid;
}

/// Returns the cell along one axis; offsets beyond the grid are clamped.
int cellAlong(double offset, double extent, int count) {
    const double cell = offset / extent * count;
    if (!(cell > 0)) return 0;
    return cell < count ? static_cast<int>(cell) : count - 1;
}

double distanceFromEdges(const Polygon& polygon, Point2 p) {
    double least = std::numeric_limits<double>::infinity();
    forEachEdge(polygon, [&](const Segment2& edge) { least = std::min(least, distance(p, edge)); });
    return least;
}

}  // namespace

bool containsWithMargin(const Polygon& polygon, Point2 p, double margin) {
    return locate(polygon, p) == Side::Inside && distanceFromEdges(polygon, p) > margin;
}

RegionIndex::RegionIndex(std::span<const Region> regions) {
    Box2 box;
    std::vector<Polygon> curves;
    for (const Region& region : regions) {
        curves.push_back(region.outline);
        curves.insert(curves.end(), region.holes.begin(), region.holes.end());
        region.forEachEdge([&](const Segment2& edge) {
            edges_.push_back(edge);
            box.add(edge.a);
        });
    }
    if (edges_.empty()) return;
    tree_ = BoxTree(boundsOfEach(edges_));
    grid_ = gridOver(box, edges_.size());
    inside_ = cellsWithin(grid_, curves);
}

Side RegionIndex::locate(Point2 p) const {
    if (edges_.empty()) return Side::Outside;
    const Box2& limits = grid_.limits;
    if (!limits.contains(p)) return Side::Outside;
    const std::size_t cell =
        grid_.cell(cellAlong(p.x - limits.low.x, limits.width(), grid_.columns),
                   cellAlong(p.y - limits.low.y, limits.depth(), grid_.rows));
    const Point2 known = grid_.center(cell);
    bool is_same = true, touches = false, is_known = true;
    Box2 window;
    window.add(p);
    window.add(known);
    edgesIn(window, [&](const Segment2& edge) {
        touches = touches || intersects(edge, {p, p});
        is_known = is_known && !intersects(edge, {known, known});
        // Tests one edge; an even number of crossings keeps the side.
        if (!insideByParity(p, known, {&edge, 1})) is_same = !is_same;
    });
    if (touches) return Side::Boundary;
    if (!is_known) return locateByRay(p);
    return inside_.test(cell) == is_same ? Side::Inside : Side::Outside;
}

/// Counts crossings of the ray towards +x, end points by the half-open rule.
Side RegionIndex::locateByRay(Point2 p) const {
    bool inside = false;
    edgesIn({p, {std::max(grid_.limits.high.x, p.x), p.y}}, [&](const Segment2& edge) {
        const auto& [low, high] = edge.a.y < edge.b.y ? edge : Segment2{edge.b, edge.a};
        if ((low.y > p.y) != (high.y > p.y) && orientation(low, high, p) == Turn::Left)
            inside = !inside;
    });
    return inside ? Side::Inside : Side::Outside;
}

bool RegionIndex::isWithin(Point2 p, double reach) const {
    if (locate(p) != Side::Outside) return true;
    const Vec2 margin{reach, reach};
    bool is_near = false;
    edgesIn({p - margin, p + margin},
            [&](const Segment2& edge) { is_near = is_near || distance(p, edge) <= reach; });
    return is_near;
}

PolygonIndex::PolygonIndex(std::span<const Polygon> polygons)
    : polygons_(polygons), boxes_(boundsOfEach(polygons)) {}

std::optional<std::size_t> PolygonIndex::holder(Point2 p) const {
    std::optional<std::size_t> holder;
    boxes_.search({p, p}, [&](std::size_t i) {
        if ((!holder || i < *holder) && locate(polygons_[i], p) != Side::Outside) holder = i;
    });
    return holder;
}

bool PolygonIndex::containsWithMargin(Point2 p, double margin) const {
    bool inside = false;
    boxes_.search({p, p}, [&](std::size_t i) {
        inside = inside || ispace::containsWithMargin(polygons_[i], p, margin);
    });
    return inside;
}

std::vector<Polygon> PolygonIndex::touching(Point2 p, double reach) const {
    const Vec2 margin{reach, reach};
    std::vector<Polygon> touching;
    boxes_.search({p - margin, p + margin}, [&](std::size_t i) {
        if (distanceFromEdges(polygons_[i], p) <= reach) touching.push_back(polygons_[i]);
    });
    return touching;
}

}  // namespace ispace
