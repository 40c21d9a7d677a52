// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "geom/overlay/overlay_lattice.h"
#include "geom/overlay/overlay_strips.h"
#include "geom/tolerance.h"

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
        putLargestFirst();
    }

  private:
    /// Chords that merge keep the lowest number (lattice::merged): the largest circle, so that a
    /// union of near circles is not smaller than one of them.
    void putLargestFirst() {
        std::vector<Index> order(circles.size()), number(circles.size());
        std::iota(order.begin(), order.end(), Index{0});
        std::sort(order.begin(), order.end(), [this](Index i, Index k) {
            const Circle &a = circles[i], &b = circles[k];
            if (a.radius != b.radius) return a.radius > b.radius;
            return a.center != b.center ? lexLess(a.center, b.center) : i < k;
        });
        std::vector<Circle> sorted;
        sorted.reserve(circles.size());
        for (const Index i : order) {
            number[i] = static_cast<Index>(sorted.size());
            sorted.push_back(circles[i]);
        }
        circles = std::move(sorted);
        for (Vertex& vertex : vertices)
            if (vertex.circle != kNone) vertex.circle = number[vertex.circle];
    }

    /// Inner vertices lie at the same directions for all arcs of a circle, so that arcs of sensors
    /// with the same position become the same chords.
    void addArc(const CurveEdge& edge, Index layer) {
        using std::numbers::pi;
        const Index circle = circleOf({edge.center, std::abs(edge.radius)});
        const auto [center, radius] = circles[circle];
        vertices.push_back({edge.from, layer, circle});
        const double step = 2 * pi / chords_[circle];
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

    /// Number of chords that are within kChordError of a circle.
    static double chordsOf(double radius) {
        // A chord over 2x has the sagitta r (1 - cos x) = 2 r sin(x / 2)^2.
        constexpr double kMin = 16, kMax = 1 << 16;
        const double half = 2 * std::asin(std::min(1.0, std::sqrt(kChordError / (2 * radius))));
        return std::clamp(std::ceil(std::numbers::pi / half), kMin, kMax);
    }

    Index circleOf(const Circle& circle) {
        double chords = chordsOf(circle.radius);
        const double own = chords;
        const auto first = known_.lower_bound(circle.center.x - kNearCircle);
        for (auto it = first; it != known_.end() && it->first <= circle.center.x + kNearCircle;
             ++it) {
            const Circle& other = circles[it->second];
            const double off = std::max({std::abs(other.center.x - circle.center.x),
                                         std::abs(other.center.y - circle.center.y),
                                         std::abs(other.radius - circle.radius)});
            if (off <= kContactTolerance) return it->second;
            constexpr double kAlmost = 0.98;  // the chords are within 1.05 * kChordError
            if (off <= kNearCircle && chords_[it->second] >= kAlmost * own)
                chords = chords_[it->second];
        }
        const auto number = static_cast<Index>(circles.size());
        known_.emplace(circle.center.x, number);
        circles.push_back(circle);
        chords_.push_back(chords);
        return number;
    }

    /// Circles that differ by less have as many chords each: of two that differ by less than a
    /// chord's sagitta, each polygon would else be the outer one in turn.
    static constexpr double kNearCircle = 20 * kChordError;

    std::multimap<double, Index> known_;  // by the x of their middles
    std::vector<double> chords_;          // of each circle
};

/// Maps points in a box to integer coordinates.
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
    [[nodiscard]] Point2 placeOf(lattice::Point p) const {
        return middle_ + Vec2{unit_ * p.x, unit_ * p.y};
    }

  private:
    /// Rounded to a multiple of the step where doubles resolve it, so that equal points round
    /// equally for any middle.
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

/// Clips a segment to a box (Liang and Barsky, 1984); its ends round.
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

/// Computes the area between the chord p -> q and the arc: positive if the arc lies to the right.
/// By radial projection, so that pieces of arcs add up.
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
    table.reserve(curves.vertices.size() + 2 * walls.size());
    std::size_t begin = 0;
    for (const std::size_t end : curves.ends) {
        if (begin == end) continue;
        const Index first = table.add(lattice.pointOf(curves.vertices[begin].at));
        Index from = first;
        for (std::size_t i = begin; i < end; ++i) {
            // Closes the curve even if its last edge does not.
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

/// Builds the stored data of an overlay from its parts.
class Overlay::Maker {
  public:
    Maker(Overlay& overlay, const ChordCurves& curves, const Coarse& coarse)
        : overlay_(overlay), curves_(curves), coarse_(coarse) {}

    /// As lattice::PartVisitor.
    std::function<void()> visit(lattice::Part part) {
        auto kept = std::make_shared<Kept>();
        if (!coarse_.label) kept->edges.reserve(part.edges.size());
        for (std::size_t i = 0; i < part.edges.size(); ++i)
            add(part.edges[i], part.labels[i], part.points, *kept);
        kept->points = std::move(part.points);
        return [this, kept, is_whole = part.is_whole] { take(*kept, is_whole); };
    }

    void finish() {
        overlay_.ends_.insert(overlay_.ends_.end(), ends_of_walls_.begin(), ends_of_walls_.end());
        if (overlay_.points_.empty())
            for (const auto& [x, y] : table_.points()) overlay_.points_.push_back({x, y});
    }

  private:
    /// Of a part; ends are numbers of its points.
    struct Kept {
        std::vector<Edge> edges;
        std::vector<LayerLabel> walls;
        std::vector<Ends> ends, ends_of_walls;
        std::vector<lattice::Point> points;
        std::vector<std::pair<LayerLabel, double>> areas;
    };

    void add(const lattice::Edge& line, const lattice::EdgeLabels& labels,
             const std::vector<lattice::Point>& points, Kept& kept) const {
        const Ends ends{line.from, line.to, line.is_wall};
        LayerLabel same = labels.left;  // on both sides
        bool differ = labels.left != labels.right;
        if (differ) {
            const lattice::Point p = points[line.from], q = points[line.to];
            Edge& edge = kept.edges.emplace_back();
            edge.from = overlay_.placeOf({p.x, p.y});
            edge.to = overlay_.placeOf({q.x, q.y});
            edge.left = labels.left;
            edge.right = labels.right;
            if (line.circle != kNone) {
                const Circle& circle = curves_.circles[line.circle];
                edge.bulge = bulgeOf(circle, edge.from, edge.to);
                edge.radius = circle.radius;
                edge.center = circle.center;
            }
            if (coarse_.label) {
                const double area = overlay_.areaLeftOf(edge);
                kept.areas.emplace_back(edge.left, area);
                kept.areas.emplace_back(edge.right, -area);
                edge.left = same = coarse_.label(edge.left);
                edge.right = coarse_.label(edge.right);
                differ = edge.left != edge.right;
            }
            if (differ)
                kept.ends.push_back(ends);
            else
                kept.edges.pop_back();
        } else if (coarse_.label) {
            same = coarse_.label(same);
        }
        if (line.is_wall && !differ && same != LayerLabel{}) {
            kept.walls.push_back(same);
            kept.ends_of_walls.push_back(ends);
        }
    }

    /// In the order of parts.
    void take(Kept& kept, bool is_whole) {
        for (const auto& [label, area] : kept.areas) coarse_.add_area(label, area);
        if (is_whole) {
            overlay_.edges_ = std::move(kept.edges);
            overlay_.walls_ = std::move(kept.walls);
            overlay_.ends_ = std::move(kept.ends);
            ends_of_walls_ = std::move(kept.ends_of_walls);
            overlay_.points_.reserve(kept.points.size());
            for (const auto& [x, y] : kept.points) overlay_.points_.push_back({x, y});
            return;
        }
        numbers_.assign(kept.points.size(), kNone);
        const auto number = [&](Index point) {
            if (numbers_[point] == kNone) numbers_[point] = table_.add(kept.points[point]);
            return numbers_[point];
        };
        const auto append = [&](const std::vector<Ends>& ends, std::vector<Ends>& all) {
            for (const Ends& e : ends) all.push_back({number(e.from), number(e.to), e.is_wall});
        };
        append(kept.ends, overlay_.ends_);
        append(kept.ends_of_walls, ends_of_walls_);
        overlay_.edges_.insert(overlay_.edges_.end(), kept.edges.begin(), kept.edges.end());
        overlay_.walls_.insert(overlay_.walls_.end(), kept.walls.begin(), kept.walls.end());
        lattice::mustBeFew(overlay_.edges_.size());
        kept = {};
    }

    Overlay& overlay_;
    const ChordCurves& curves_;
    const Coarse& coarse_;
    std::vector<Ends> ends_of_walls_;
    lattice::PointTable table_;
    std::vector<Index> numbers_;  // of a part's points in the table
};

namespace {

/// Stores layers and walls, rounded to the lattice.
struct Rounded {
    ChordCurves curves;
    Lattice lattice;
    lattice::SetStore sets;

    Rounded(std::span<const Layer> layers)
        : curves(layers), lattice(curves.box), sets(layers.size()) {}

    void forEachPart(std::span<const Layer> layers, std::span<const Segment2> walls,
                     std::size_t most_crossings, const lattice::PartVisitor& visit) {
        lattice::PointTable table;
        std::vector<lattice::Edge> edges =
            latticeEdges(curves, layers.size(), walls, lattice, table);
        curves.vertices = {};
        edges = merged(std::move(edges), table.points(), sets);
        lattice::forEachPart(layers, std::move(edges), std::move(table), sets, 0, visit,
                             most_crossings);
    }
};

}  // namespace

Overlay::Overlay(std::span<const Layer> layers, std::span<const Segment2> walls,
                 const Coarse& coarse) {
    Rounded rounded(layers);
    unit_ = rounded.lattice.unit();
    if (unit_ == 0) return;
    middle_ = rounded.lattice.middle();
    Maker maker(*this, rounded.curves, coarse);
    rounded.forEachPart(layers, walls, coarse.most_crossings,
                        [&](lattice::Part part) { return maker.visit(std::move(part)); });
    maker.finish();
}

void forEachArea(std::span<const Layer> layers,
                 const std::function<void(const LayerLabel&, double)>& add,
                 std::size_t most_crossings) {
    /// Adds the area that each edge between different labels contributes to the face on its left.
    struct Areas {
        std::vector<lattice::EdgeLabels> labels;
        std::vector<double> areas;
    };
    Rounded rounded(layers);
    const Lattice& lattice = rounded.lattice;
    if (lattice.unit() == 0) return;
    rounded.forEachPart(layers, {}, most_crossings, [&](lattice::Part part) {
        auto found = std::make_shared<Areas>(Areas{std::move(part.labels), {}});
        std::size_t count = 0;
        found->areas.reserve(part.edges.size());
        for (std::size_t i = 0; i < part.edges.size(); ++i) {
            if (found->labels[i].left == found->labels[i].right) continue;
            const lattice::Edge& edge = part.edges[i];
            const Point2 from = lattice.placeOf(part.points[edge.from]);
            const Point2 to = lattice.placeOf(part.points[edge.to]);
            const double bulge =
                edge.circle == kNone ? 0 : bulgeOf(rounded.curves.circles[edge.circle], from, to);
            found->areas.push_back(Overlay::areaLeftOf(lattice.middle(), from, to, bulge));
            found->labels[count++] = found->labels[i];
        }
        return [found, &add] {
            for (std::size_t i = 0; i < found->areas.size(); ++i) {
                add(found->labels[i].left, found->areas[i]);
                add(found->labels[i].right, -found->areas[i]);
            }
            *found = {};
        };
    });
}

}  // namespace ispace
