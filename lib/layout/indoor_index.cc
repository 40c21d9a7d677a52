// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/indoor_index.h"

#include "geom/predicates.h"
#include "layout/overlap.h"

namespace ispace {

IndoorIndex::IndoorIndex(const Regions& regions) {
    regions.forEachEdge([this](const Segment2& edge) { edges_.push_back(edge); });
    std::vector<Box2> boxes;
    boxes.reserve(edges_.size());
    for (const Segment2& edge : edges_) {
        boxes.push_back(bounds(edge));
        right_ = std::max(right_, boxes.back().high.x);
    }
    tree_ = BoxTree(boxes);
}

Side IndoorIndex::locate(Point2 p) const {
    // Crossings of the ray towards +x, end points by the half-open rule; orientation is exact.
    bool inside = false, touches = false;
    edgesIn({p, {std::max(right_, p.x), p.y}}, [&](const Segment2& edge) {
        const bool is_rising = edge.a.y < edge.b.y;
        const auto& [low, high] = is_rising ? edge : Segment2{edge.b, edge.a};
        const Turn turn = orientation(low, high, p);
        if (turn == Turn::Straight) {
            touches = touches || intersects(edge, {p, p});
        } else if ((low.y > p.y) != (high.y > p.y) && turn == Turn::Left) {
            inside = !inside;
        }
    });
    return touches ? Side::Boundary : inside ? Side::Inside : Side::Outside;
}

bool IndoorIndex::isOut(Point2 p) const {
    if (locate(p) != Side::Outside) return false;
    const Vec2 margin{kTouching, kTouching};
    bool is_near = false;
    edgesIn({p - margin, p + margin},
            [&](const Segment2& edge) { is_near = is_near || distance(p, edge) <= kTouching; });
    return !is_near;
}

bool IndoorIndex::hasEdgeIn(const Box2& window) const {
    bool any = false;
    edgesIn(window, [&any](const Segment2& /*edge*/) { any = true; });
    return any;
}

}  // namespace ispace
