// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "cover/map_parts.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// One side of a box: what has a coordinate of at least (or at most) `bound`.
struct HalfPlane {
    bool along_x;
    bool above;
    double bound;

    [[nodiscard]] double coordinate(Point2 p) const { return along_x ? p.x : p.y; }
    [[nodiscard]] bool holds(Point2 p) const {
        return above ? coordinate(p) >= bound : coordinate(p) <= bound;
    }
    /// Where a -> b passes the bound. \pre one of the ends is held
    [[nodiscard]] Point2 crossing(Point2 a, Point2 b) const {
        const double share = (bound - coordinate(a)) / (coordinate(b) - coordinate(a));
        const Point2 p = a + share * (b - a);
        return along_x ? Point2{bound, p.y} : Point2{p.x, bound};
    }
};

std::array<HalfPlane, 4> sidesOf(const Box2& box) {
    return {HalfPlane{true, true, box.low.x}, HalfPlane{true, false, box.high.x},
            HalfPlane{false, true, box.low.y}, HalfPlane{false, false, box.high.y}};
}

bool within(const Box2& inner, const Box2& outer) {
    return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y &&
           inner.high.x <= outer.high.x && inner.high.y <= outer.high.y;
}

/// A closed curve thinned in two halves, which meet at vertices far apart.
Polygon thinnedCurve(const Polygon& curve, double tolerance) {
    if (curve.size() < 4) return curve;
    const auto farther = [&](Point2 a, Point2 b) {
        return distance(curve.front(), a) < distance(curve.front(), b);
    };
    const auto middle = std::max_element(curve.begin(), curve.end(), farther);
    Polygon result = thinned(Polygon(curve.begin(), middle + 1), tolerance);
    Polygon rest(middle, curve.end());
    rest.push_back(curve.front());
    rest = thinned(rest, tolerance);
    result.insert(result.end(), rest.begin() + 1, rest.end() - 1);
    return result;
}

}  // namespace

std::vector<Point2> thinned(const std::vector<Point2>& points, double tolerance) {
    if (points.size() < 3) return points;
    std::vector<bool> keep(points.size());
    keep.front() = keep.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        const Segment2 chord{points[first], points[last]};
        double farthest = tolerance;
        std::size_t at = first;
        for (std::size_t i = first + 1; i < last; ++i) {
            if (const double off = distance(points[i], chord); off > farthest) {
                farthest = off;
                at = i;
            }
        }
        if (at == first) continue;
        keep[at] = true;
        open.insert(open.end(), {{first, at}, {at, last}});
    }
    std::vector<Point2> kept;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (keep[i]) kept.push_back(points[i]);
    return kept;
}

Polygon clipped(const Polygon& curve, const Box2& box) {
    if (curve.empty() || within(bounds(curve), box)) return curve;
    Polygon result = curve;
    for (const HalfPlane& side : sidesOf(box)) {
        Polygon kept;
        kept.reserve(result.size() + 4);
        for (std::size_t i = 0; i < result.size(); ++i) {
            const Point2 from = result[i == 0 ? result.size() - 1 : i - 1], to = result[i];
            if (side.holds(from) != side.holds(to)) kept.push_back(side.crossing(from, to));
            if (side.holds(to)) kept.push_back(to);
        }
        result = std::move(kept);
    }
    return result;
}

std::optional<Segment2> clipped(const Segment2& segment, const Box2& box) {
    Segment2 part = segment;
    for (const HalfPlane& side : sidesOf(box)) {
        const bool from = side.holds(part.a), to = side.holds(part.b);
        if (!from && !to) return std::nullopt;
        if (from && to) continue;
        (from ? part.b : part.a) = side.crossing(part.a, part.b);
    }
    return part;
}

std::vector<Polygon> drawable(const MapPicture& map, std::vector<Polygon> curves) {
    // Far enough outside for strokes along the box not to be seen.
    const double rim = 4 * map.em / map.view.scale, tolerance = 0.03 / map.view.scale;
    const Box2 box{{map.limits().low.x - rim, map.limits().low.y - rim},
                   {map.limits().high.x + rim, map.limits().high.y + rim}};
    for (Polygon& curve : curves) curve = thinnedCurve(clipped(curve, box), tolerance);
    std::erase_if(curves, [](const Polygon& curve) { return curve.size() < 3; });
    return curves;
}

std::vector<Polygon> drawable(const MapPicture& map, const std::vector<Curve>& curves) {
    std::vector<Polygon> polygons;
    polygons.reserve(curves.size());
    for (const Curve& curve : curves) polygons.push_back(chords(curve, 0.03 / map.view.scale));
    return drawable(map, std::move(polygons));
}

}  // namespace ispace
