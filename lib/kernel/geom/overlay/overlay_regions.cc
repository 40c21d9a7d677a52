// SPDX-License-Identifier: GPL-3.0-or-later
// Builds regions of an overlay, with chords or with arcs.
#include "geom/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geom/arrangement.h"
#include "geom/overlay/overlay_lattice.h"
#include "geom/predicates.h"
#include "geom/tolerance.h"

namespace ispace {

using lattice::Index;

namespace {

/// Replaces chords by the arcs of the circles that were flattened; flattening them again gives the
/// same chords.
class ArcTable {
  public:
    explicit ArcTable(std::span<const Overlay::Edge> edges) {
        for (const Overlay::Edge& edge : edges) {
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

    /// Vertex through which a chord encloses the area of its arc; nullopt for straight edges, and
    /// for arcs so short that the vertex would be a spike.
    [[nodiscard]] std::optional<Point2> apexOf(Segment2 chord) const {
        if (lexLess(chord.b, chord.a)) std::swap(chord.a, chord.b);  // the same for both neighbours
        const CurveEdge edge = edgeFrom(chord.a, chord.b);
        if (!edge.isArc()) return std::nullopt;
        Curve cap = withEndsOnCircles({edge});
        cap.push_back({chord.b, chord.a});
        constexpr double kSteepest = 0.25;
        const Vec2 along = chord.b - chord.a;
        const double height = -2 * signedArea(cap) / dot(along, along);  // in lengths of the chord
        if (std::abs(height) > kSteepest) return std::nullopt;
        return chord.a + 0.5 * along + height * perpendicular(along);
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
    /// that of Overlay::Edge::bulge.
    static Curve withEndsOnCircles(const Curve& curve) {
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
                return distance(p, q) > kContactTolerance ? q : p;
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

std::vector<Curve> Overlay::withArcs(std::span<const Region> regions) const {
    const ArcTable arcs(edges_);
    std::vector<Curve> curves;
    for (const Region& region : regions)
        for (const Polygon& polygon : curvesOf(region)) curves.push_back(arcs.curveOf(polygon));
    return curves;
}

std::vector<double> Overlay::areasOf(std::span<const Region> regions) const {
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

std::vector<Region> withArcAreas(const Overlay& overlay, std::vector<Region> regions) {
    const ArcTable arcs(overlay.edges());
    const auto refine = [&arcs](Polygon& polygon) {
        Polygon refined;
        refined.reserve(2 * polygon.size());
        forEachEdge(polygon, [&](const Segment2& edge) {
            refined.push_back(edge.a);
            if (const auto apex = arcs.apexOf(edge)) refined.push_back(*apex);
        });
        polygon = std::move(refined);
    };
    for (Region& region : regions) {
        refine(region.outline);
        for (Polygon& hole : region.holes) refine(hole);
    }
    return regions;
}

Overlay Overlay::partOf(std::span<const std::size_t> chosen) const {
    Overlay part(middle_, unit_);
    std::vector<std::uint32_t> used;
    used.reserve(2 * chosen.size());
    for (const std::size_t i : chosen) {
        used.push_back(ends_[i].from);
        used.push_back(ends_[i].to);
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    part.points_.reserve(used.size());
    for (const std::uint32_t point : used) part.points_.push_back(points_[point]);
    const auto own = [&used](std::uint32_t point) {
        return static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), point) -
                                          used.begin());
    };
    part.ends_.reserve(chosen.size());
    for (const std::size_t i : chosen) {
        part.ends_.push_back({own(ends_[i].from), own(ends_[i].to), ends_[i].is_wall});
        if (i < edges_.size())
            part.edges_.push_back(edges_[i]);
        else
            part.walls_.push_back(walls_[i - edges_.size()]);
    }
    return part;
}

std::vector<Region> Overlay::trace(const std::vector<Sides>& sides) const {
    std::vector<lattice::Point> points;
    points.reserve(points_.size());
    for (const auto& [x, y] : points_) points.push_back({x, y});
    std::vector<plane::Line> lines;
    std::vector<bool> has_piece;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i] == kNowhere) continue;
        lines.push_back({ends_[i].from, ends_[i].to});
        has_piece.push_back((sides[i] & kLeft) != 0);
        has_piece.push_back((sides[i] & kRight) != 0);
    }
    const plane::Faces<lattice::Point> faces(points, lines, std::move(has_piece));
    const plane::Graph<lattice::Point>& graph = faces.graph();
    const auto goes_on = [&](Index before, Index half) {
        return lattice::cross(graph.pointOf(graph.source(before)),
                              graph.pointOf(graph.source(half)),
                              graph.pointOf(graph.target(half))) == 0;
    };
    std::vector<Region> regions(faces.count());
    const auto face_of = [&](Index half) { return faces.of(half); };
    faces.forEachBoundary(face_of, [&](Index face, const plane::Loop& loop, bool is_outline) {
        Polygon curve;
        curve.reserve(loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i)
            if (!goes_on(loop[i == 0 ? loop.size() - 1 : i - 1], loop[i]))
                curve.push_back(place(graph.source(loop[i])));
        rotateToLowest(curve);
        if (is_outline)
            regions[face].outline = std::move(curve);
        else
            regions[face].holes.push_back(std::move(curve));
    });
    putInOrder(regions);
    return regions;
}

}  // namespace ispace
