// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "geom/arrangement.h"
#include "geom/overlay_lattice.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

using lattice::Index;
using lattice::kNone;

/// Of arcs; the same for all arcs of one circle.
struct Circle {
    Point2 center;
    double radius;
};

/// Curves with chords for arcs: each vertex and the edge that leaves it.
struct ChordCurves {
    struct Vertex {
        Point2 at;
        Index layer;
        Index circle;
    };
    std::vector<Vertex> vertices;
    std::vector<std::size_t> ends;  // of the curves
    std::vector<Circle> circles;
    Box2 box;

    explicit ChordCurves(std::span<const Layer> layers) {
        std::size_t count = 0;
        for (const Layer& layer : layers)
            for (const Curve& curve : layer.curves) count += curve.size();
        vertices.reserve(count);
        for (Index i = 0; i < layers.size(); ++i) {
            for (const Curve& curve : layers[i].curves) {
                for (const CurveEdge& edge : curve) {
                    if (edge.isArc())
                        addArc(edge, i);
                    else
                        vertices.push_back({edge.from, i, kNone});
                }
                ends.push_back(vertices.size());
            }
        }
        for (const Vertex& vertex : vertices) box.add(vertex.at);
    }

  private:
    /// Inner vertices lie at the same directions for all arcs of a circle, so that those of
    /// sensors that stand at one place become the same chords.
    void addArc(const CurveEdge& edge, Index layer) {
        using std::numbers::pi;
        const Index circle = circleOf({edge.center, std::abs(edge.radius)});
        const auto [center, radius] = circles[circle];
        vertices.push_back({edge.from, layer, circle});
        // A chord over 2x has the sagitta r (1 - cos x) = 2 r sin(x / 2)^2.
        constexpr double kMin = 16, kMax = 1 << 16;
        const double half = 2 * std::asin(std::min(1.0, std::sqrt(kChordError / (2 * radius))));
        const double chords = std::clamp(std::ceil(pi / half), kMin, kMax);
        const double step = 2 * pi / chords;
        const Vec2 a = edge.from - center, b = edge.to - center;
        const double first = std::atan2(a.y, a.x);
        const double turn = edge.radius > 0 ? 1 : -1;
        double span = turn * (std::atan2(b.y, b.x) - first);
        if (span < 0) span += 2 * pi;
        if (span > 1.5 * pi) return;  // backwards, by rounding: it has no length
        // Steps from `first` to the next direction, if that is not next to the end.
        constexpr double kNear = 1.0 / 64;
        const double last = turn * first / step + span / step - kNear;
        for (double k = std::floor(turn * first / step + kNear) + 1; k < last; ++k) {
            const double angle = turn * k * step;
            vertices.push_back(
                {center + radius * Vec2{std::cos(angle), std::sin(angle)}, layer, circle});
        }
    }

    /// Circles this near to each other are one: the same place reckoned in two ways (on a robot,
    /// and written). Else chords that coincide on the lattice would be of two circles.
    static constexpr double kSameCircle = 1e-9;

    Index circleOf(const Circle& circle) {
        const auto first = known_.lower_bound(circle.center.x - kSameCircle);
        for (auto it = first; it != known_.end() && it->first <= circle.center.x + kSameCircle;
             ++it) {
            const Circle& other = circles[it->second];
            if (std::abs(other.center.y - circle.center.y) <= kSameCircle &&
                std::abs(other.radius - circle.radius) <= kSameCircle)
                return it->second;
        }
        known_.emplace(circle.center.x, static_cast<Index>(circles.size()));
        circles.push_back(circle);
        return static_cast<Index>(circles.size() - 1);
    }

    std::multimap<double, Index> known_;  // by the x of their middles
};

/// Integer coordinates for the places in a box.
class Lattice {
  public:
    explicit Lattice(const Box2& box) {
        // Halves first: the whole extent may be more than a double holds.
        const double half =
            std::max(box.high.x / 2 - box.low.x / 2, box.high.y / 2 - box.low.y / 2);
        if (!(half > 0)) return;
        int exponent;
        std::frexp(half, &exponent);  // half < 2^exponent
        unit_ = std::ldexp(1.0, std::max(exponent - lattice::kBits, -1000));
        middle_ = {middle(box.low.x, box.high.x), middle(box.low.y, box.high.y)};
    }

    [[nodiscard]] double unit() const { return unit_; }
    [[nodiscard]] Point2 middle() const { return middle_; }
    [[nodiscard]] lattice::Point pointOf(Point2 p) const {
        return {rounded(p.x - middle_.x), rounded(p.y - middle_.y)};
    }

  private:
    /// A multiple of the step where doubles tell them apart, so that the same places are rounded
    /// the same way wherever the middle is.
    [[nodiscard]] double middle(double low, double high) const {
        const double v = low / 2 + high / 2, steps = v / unit_;
        return std::abs(steps) < 0x1p52 ? std::nearbyint(steps) * unit_ : v;
    }
    [[nodiscard]] std::int32_t rounded(double offset) const {
        constexpr double kMax = 1 << lattice::kBits;
        return static_cast<std::int32_t>(std::clamp(std::floor(offset / unit_ + 0.5), -kMax, kMax));
    }

    double unit_ = 0;
    Point2 middle_;
};

/// The part of a segment in a box (Liang and Barsky, 1984); its ends round.
std::optional<Segment2> clipped(const Segment2& s, const Box2& box) {
    double from = 0, to = 1;
    const auto clip = [&](double a, double d, double low, double high) {
        if (d == 0) return low <= a && a <= high;
        const double t0 = (low - a) / d, t1 = (high - a) / d;
        from = std::max(from, std::min(t0, t1));
        to = std::min(to, std::max(t0, t1));
        return true;
    };
    const Vec2 d = s.b - s.a;
    if (!clip(s.a.x, d.x, box.low.x, box.high.x) || !clip(s.a.y, d.y, box.low.y, box.high.y))
        return std::nullopt;
    if (!(from < to)) return std::nullopt;
    return Segment2{from > 0 ? s.a + from * d : s.a, to < 1 ? s.a + to * d : s.b};
}

/// Area between the chord p -> q and the arc: positive if the arc lies to the right. By radial
/// projection, so that pieces of arcs add up.
double bulgeOf(const Circle& circle, Point2 p, Point2 q) {
    const Vec2 a = p - circle.center, b = q - circle.center;
    const double along = dot(a, b), across = cross(a, b);
    double angle;
    constexpr double kSmall = 0.02;
    if (const double t = across / along; along > 0 && std::abs(t) < kSmall) {
        const double u = t * t;  // the next term is below 2^-53
        angle = t * (1 - u * (1.0 / 3 - u * (1.0 / 5 - u * (1.0 / 7 - u * (1.0 / 9)))));
    } else {
        angle = std::atan2(across, along);
    }
    return (circle.radius * circle.radius * angle - across) / 2;
}

std::vector<lattice::Edge> latticeEdges(const ChordCurves& curves, std::size_t layers,
                                        std::span<const Segment2> walls, const Lattice& lattice,
                                        lattice::PointTable& table) {
    std::vector<lattice::Edge> edges;
    edges.reserve(curves.vertices.size() + walls.size());
    table.reserve(4 * curves.vertices.size() + 2 * walls.size());
    std::size_t begin = 0;
    for (const std::size_t end : curves.ends) {
        if (begin == end) continue;
        const Index first = table.add(lattice.pointOf(curves.vertices[begin].at));
        Index from = first;
        for (std::size_t i = begin; i < end; ++i) {
            // Closed whatever the curve says.
            const Index to =
                i + 1 == end ? first : table.add(lattice.pointOf(curves.vertices[i + 1].at));
            edges.push_back({from, to, curves.vertices[i].layer, curves.vertices[i].circle, false});
            from = to;
        }
        begin = end;
    }
    for (const Segment2& wall : walls) {
        const auto part = clipped(wall, curves.box);
        if (!part) continue;
        edges.push_back({table.add(lattice.pointOf(part->a)), table.add(lattice.pointOf(part->b)),
                         static_cast<Index>(layers), kNone, true});
    }
    return edges;
}

}  // namespace

Overlay::Overlay(std::span<const Layer> layers, std::span<const Segment2> walls) {
    const ChordCurves curves(layers);
    const Lattice lattice(curves.box);
    unit_ = lattice.unit();
    if (unit_ == 0) return;
    middle_ = lattice.middle();
    lattice::PointTable table;
    lattice::SetStore sets(layers.size());
    std::vector<lattice::Edge> edges = latticeEdges(curves, layers.size(), walls, lattice, table);
    edges = snapRounded(merged(std::move(edges), table.points(), sets), table, sets);
    const auto labels = labelsOf(layers, table.points(), edges, sets);

    points_.reserve(table.points().size());
    for (const auto& [x, y] : table.points()) points_.push_back({x, y});
    edges_.reserve(edges.size());
    ends_.reserve(edges.size());
    std::vector<Ends> ends_of_walls;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto& [left, right] = labels[i];
        const lattice::Edge& edge = edges[i];
        const Ends ends{edge.from, edge.to, edge.is_wall};
        if (left != right) {
            const Point2 from = place(edge.from), to = place(edge.to);
            edges_.push_back({from, to, left, right});
            if (edge.circle != kNone) {
                const Circle& circle = curves.circles[edge.circle];
                edges_.back().bulge = bulgeOf(circle, from, to);
                edges_.back().radius = circle.radius;
                edges_.back().center = circle.center;
            }
            ends_.push_back(ends);
        } else if (edge.is_wall && left != LayerLabel{}) {
            walls_.push_back(left);
            ends_of_walls.push_back(ends);
        }
    }
    ends_.insert(ends_.end(), ends_of_walls.begin(), ends_of_walls.end());
}

namespace {

/// Puts arcs back in the place of chords, those of the circles that were laid out: what is laid out
/// again then coincides with them as before.
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
