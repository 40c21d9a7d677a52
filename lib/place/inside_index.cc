// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/inside_index.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/predicates.h"

namespace ispace {

namespace {

/// About as many cells as keep building quick, and two or three to an edge.
int cellsAcross(double extent, double other, std::size_t edges) {
    constexpr double kFewest = 1024, kMax = 250'000, kMaxAcross = 2000;
    const double cells = std::clamp(3 * static_cast<double>(edges), kFewest, kMax);
    const double across = std::sqrt(cells * extent / other);
    // Of what has no extent in one direction one gets a row.
    return std::isfinite(across) ? static_cast<int>(std::clamp(across, 1.0, kMaxAcross)) : 1;
}

/// Cells a little beyond the box, by odd shares: their centres shall not lie on the round numbers
/// that walls are drawn at.
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

/// The cell along one axis, of a place that may lie beyond the grid.
int cellAlong(double offset, double extent, int count) {
    const double cell = offset / extent * count;
    if (!(cell > 0)) return 0;
    return cell < count ? static_cast<int>(cell) : count - 1;
}

}  // namespace

InsideIndex::InsideIndex(std::vector<Region> regions) : regions_(std::move(regions)) {
    Box2 box;
    for (const Region& region : regions_)
        region.forEachEdge([&](const Segment2& edge) {
            edges_.push_back(edge);
            box.add(edge.a);
        });
    if (edges_.empty()) return;
    std::vector<Box2> boxes;
    boxes.reserve(edges_.size());
    for (const Segment2& edge : edges_) boxes.push_back(bounds(edge));
    tree_ = BoxTree(boxes);
    grid_ = gridOver(box, edges_.size());
    inside_ = cellsWithin(grid_, curvesOf(regions_));
}

bool InsideIndex::isInside(Point2 p) const {
    if (edges_.empty()) return false;
    const Box2& limits = grid_.limits;
    if (p.x < limits.low.x || p.x > limits.high.x || p.y < limits.low.y || p.y > limits.high.y)
        return false;
    const std::size_t cell =
        grid_.cell(cellAlong(p.x - limits.low.x, limits.width(), grid_.columns),
                   cellAlong(p.y - limits.low.y, limits.depth(), grid_.rows));
    const Point2 known = grid_.center(cell);
    bool is_same = true, touches = false, is_known = true;
    Box2 window;
    window.add(p);
    window.add(known);
    tree_.search(window, [&](std::size_t i) {
        touches = touches || intersects(edges_[i], {p, p});
        is_known = is_known && !intersects(edges_[i], {known, known});
        // One edge: an even number of crossings is none.
        if (!insideByParity(p, known, {&edges_[i], 1})) is_same = !is_same;
    });
    if (touches) return false;
    if (!is_known) return isInsideSlowly(p);
    return inside_.test(cell) == is_same;
}

bool InsideIndex::isInsideSlowly(Point2 p) const {
    return std::any_of(regions_.begin(), regions_.end(),
                       [p](const Region& region) { return region.locate(p) == Side::Inside; });
}

}  // namespace ispace
