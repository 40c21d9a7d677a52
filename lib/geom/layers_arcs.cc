// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "geom/layers.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Puts arcs back in the place of chords, those of the circles that were laid out: what is laid out
/// again then coincides with them as before.
class ArcTable {
  public:
    explicit ArcTable(std::span<const LayerOverlay::Edge> edges) {
        for (const LayerOverlay::Edge& edge : edges) {
            if (edge.radius == 0) continue;
            const double turn = edge.bulge > 0 ? 1 : -1;
            arcs_.push_back({edge.from, edge.to, turn * edge.radius, edge.center});
            arcs_.push_back({edge.to, edge.from, -turn * edge.radius, edge.center});
        }
        std::sort(arcs_.begin(), arcs_.end(), less);
    }

    [[nodiscard]] Curve curveOf(const Polygon& polygon) const {
        Curve curve;
        curve.reserve(polygon.size());
        forEachEdge(polygon, [&](const Segment2& edge) { add(edgeFrom(edge.a, edge.b), curve); });
        return withEndsOnCircles(curve);
    }

  private:
    static bool less(const CurveEdge& a, const CurveEdge& b) {
        return a.from != b.from ? lexLess(a.from, b.from) : lexLess(a.to, b.to);
    }

    [[nodiscard]] CurveEdge edgeFrom(Point2 from, Point2 to) const {
        auto found = std::lower_bound(arcs_.begin(), arcs_.end(), CurveEdge{from, to}, less);
        if (found != arcs_.end() && found->from == from && found->to == to) return *found;
        // Outlines leave out vertices where they go straight on: the first of several pieces.
        found = std::lower_bound(arcs_.begin(), arcs_.end(), from,
                                 [](const CurveEdge& a, Point2 p) { return lexLess(a.from, p); });
        for (; found != arcs_.end() && found->from == from; ++found)
            if (orientation(from, found->to, to) == Turn::Straight &&
                dot(found->to - from, to - from) > 0)
                return {from, to, found->radius, found->center};
        return {from, to};
    }

    /// Pieces of one arc one after another become one again, of at most a quarter turn.
    static void add(const CurveEdge& edge, Curve& curve) {
        if (!curve.empty() && edge.isArc() && curve.back().radius == edge.radius &&
            curve.back().center == edge.center) {
            const Vec2 from = curve.back().from - edge.center, to = edge.to - edge.center;
            if (dot(from, to) > 0) {
                curve.back().to = edge.to;
                return;
            }
        }
        curve.push_back(edge);
    }

    /// An arc that was cut has its end on a chord: from there on to the circle, so that the area is
    /// that of LayerOverlay::Edge::bulge.
    static Curve withEndsOnCircles(const Curve& curve) {
        constexpr double kNear = 1e-9;  // metres
        Curve out;
        out.reserve(curve.size());
        for (const CurveEdge& edge : curve) {
            if (!edge.isArc()) {
                out.push_back(edge);
                continue;
            }
            const auto on_circle = [&edge](Point2 p) {
                const Vec2 way = p - edge.center;
                const Point2 q = edge.center + (std::abs(edge.radius) / length(way)) * way;
                return distance(p, q) > kNear ? q : p;
            };
            const Point2 from = on_circle(edge.from), to = on_circle(edge.to);
            if (from != edge.from) out.push_back({edge.from, from});
            out.push_back({from, to, edge.radius, edge.center});
            if (to != edge.to) out.push_back({to, edge.to});
        }
        return out;
    }

    std::vector<CurveEdge> arcs_;
};

}  // namespace

std::vector<Curve> LayerOverlay::withArcs(std::span<const Region> regions) const {
    const ArcTable arcs(edges_);
    std::vector<Curve> curves;
    for (const Region& region : regions)
        for (const Polygon& polygon : curvesOf(region)) curves.push_back(arcs.curveOf(polygon));
    return curves;
}

std::vector<double> LayerOverlay::areasOf(std::span<const Region> regions) const {
    const ArcTable arcs(edges_);
    std::vector<double> areas;
    areas.reserve(regions.size());
    for (const Region& region : regions) {
        double area = 0;
        for (const Polygon& polygon : curvesOf(region)) area += signedArea(arcs.curveOf(polygon));
        areas.push_back(area);
    }
    return areas;
}

}  // namespace ispace
