// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/boolean.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "geom/box_tree.h"
#include "geom/overlay.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

bool apart(const Box2& a, const Box2& b) {
    return a.high.x < b.low.x || b.high.x < a.low.x || a.high.y < b.low.y || b.high.y < a.low.y;
}

/// Appends the edges, turned so that the curve has this orientation.
void addCurve(const Polygon& curve, bool counter_clockwise, std::vector<Segment2>& lines) {
    const bool turn = (signedArea(curve) > 0) != counter_clockwise;
    forEachEdge(curve, [&](const Segment2& e) { lines.push_back(turn ? Segment2{e.b, e.a} : e); });
}

/// Boxes of segments of some region, or of several.
struct EdgeTree {
    std::vector<Segment2> edges;
    std::vector<std::size_t> owners;  // index of the region
    BoxTree tree;

    explicit EdgeTree(std::span<const Region> regions) {
        for (std::size_t i = 0; i < regions.size(); ++i)
            regions[i].forEachEdge([&](const Segment2& edge) {
                edges.push_back(edge);
                owners.push_back(i);
            });
        std::vector<Box2> boxes;
        boxes.reserve(edges.size());
        for (const Segment2& edge : edges) boxes.push_back(bounds(edge));
        tree = BoxTree(boxes);
    }

    [[nodiscard]] bool meets(const Box2& box) const {
        bool any = false;
        tree.search(box, [&](std::size_t) { any = true; });
        return any;
    }

    /// The region that p lies in, by the parity of edges above it. \pre p lies on none of them
    [[nodiscard]] std::optional<std::size_t> regionAt(Point2 p) const {
        std::map<std::size_t, bool> odd;
        const Box2 above{p, {p.x, std::numeric_limits<double>::infinity()}};
        tree.search(above, [&](std::size_t i) {
            const auto [left, right] =
                std::minmax(edges[i].a, edges[i].b, [](Point2 a, Point2 b) { return a.x < b.x; });
            if (left.x > p.x || right.x <= p.x || orientation(left, right, p) != Turn::Right)
                return;
            bool& is_odd = odd[owners[i]];
            is_odd = !is_odd;
        });
        for (const auto& [owner, is_odd] : odd)
            if (is_odd) return owner;
        return std::nullopt;
    }
};

/// True for the boxes that meet no other one.
std::vector<bool> alone(const std::vector<Box2>& boxes) {
    const BoxTree tree(boxes);
    std::vector<bool> out(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        std::size_t met = 0;
        tree.search(boxes[i], [&met](std::size_t) { ++met; });
        out[i] = met == 1;
    }
    return out;
}

}  // namespace

std::vector<Region> difference(const Region& region, std::span<const Polygon> solids) {
    std::vector<Segment2> added, removed;
    addCurve(region.outline, true, added);
    for (const Polygon& hole : region.holes) addCurve(hole, false, added);
    const Box2 box = bounds(region.outline);
    std::vector<Box2> boxes;
    boxes.reserve(solids.size());
    for (const Polygon& solid : solids) boxes.push_back(bounds(solid));
    // Most furniture stands clear of all others and of the walls: what it covers is just a hole.
    const std::vector<bool> is_alone = alone(boxes);
    const EdgeTree walls({&region, 1});
    std::vector<std::size_t> clear;
    for (std::size_t i = 0; i < solids.size(); ++i) {
        if (apart(box, boxes[i])) continue;
        if (is_alone[i] && !walls.meets(boxes[i]))
            clear.push_back(i);
        else
            addCurve(solids[i], true, removed);
    }
    std::vector<Region> pieces = overlayDifference(added, removed);
    const EdgeTree edges(pieces);
    for (const std::size_t i : clear) {
        const auto piece = edges.regionAt(solids[i].front());
        if (!piece) continue;
        Polygon hole = solids[i];
        if (signedArea(hole) > 0) std::reverse(hole.begin(), hole.end());
        pieces[*piece].holes.push_back(std::move(hole));
    }
    return pieces;
}

std::vector<Region> difference(const Regions& regions, std::span<const Polygon> solids) {
    std::vector<Region> pieces;
    for (const Region& part : regions.parts)
        for (Region& piece : difference(part, solids)) pieces.push_back(std::move(piece));
    return pieces;
}

std::vector<Region> unite(std::span<const Polygon> solids) {
    std::vector<Segment2> lines;
    for (const Polygon& solid : solids) addCurve(solid, true, lines);
    return overlayDifference(lines, {});
}

double totalArea(std::span<const Region> regions) {
    double sum = 0;
    for (const Region& region : regions) sum += region.area();
    return sum;
}

}  // namespace ispace
