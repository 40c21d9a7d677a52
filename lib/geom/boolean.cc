// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/boolean.h"

#include "geom/overlay.h"

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

}  // namespace

std::vector<Region> difference(const Region& region, std::span<const Polygon> solids) {
    std::vector<Segment2> added, removed;
    addCurve(region.outline, true, added);
    for (const Polygon& hole : region.holes) addCurve(hole, false, added);
    const Box2 box = bounds(region.outline);
    for (const Polygon& solid : solids) {
        if (!apart(box, bounds(solid))) addCurve(solid, true, removed);
    }
    return overlayDifference(added, removed);
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
