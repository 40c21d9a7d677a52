// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/mesh.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "geom/spatial_index.h"

namespace ispace {

namespace {

constexpr std::size_t kNone = ~std::size_t{0};

/// Merges cavities with the polygons around them.
class Seams {
  public:
    explicit Seams(std::vector<Polygon> curves) : curves_(std::move(curves)) {
        root_.assign(curves_.size(), false);
        turned_.assign(curves_.size(), false);
        order_.resize(curves_.size());
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::stable_sort(order_.begin(), order_.end(), [this](std::size_t a, std::size_t b) {
            return lexLess(curves_[a].front(), curves_[b].front());
        });
        addEdges();
        linkVertices();
    }

    std::vector<Polygon> join() {
        // From left to right, so that the polygon around a cavity is decided before the cavity.
        std::vector<Seam> seams;
        rank_.resize(curves_.size());
        for (std::size_t i = 0; i < order_.size(); ++i) rank_[order_[i]] = i;
        for (const std::size_t curve : order_) {
            root_[curve] = signedArea(curves_[curve]) > 0;
            if (root_[curve]) continue;
            if (const auto hit = surrounding(curve))
                seams.push_back({hit->edge, curve, hit->place});
            else
                turn(curve);
        }
        splice(seams);
        std::vector<Polygon> out;
        for (std::size_t i = 0; i < curves_.size(); ++i)
            if (root_[i]) out.push_back(collect(first_[i]));
        return out;
    }

  private:
    struct Edge {
        std::size_t curve, vertex;  // from this vertex of the curve to its next
    };
    struct Hit {
        std::size_t edge;
        Point2 place;
    };
    struct Seam {
        std::size_t edge, cavity;
        Point2 place;
    };

    [[nodiscard]] Segment2 line(std::size_t edge) const {
        const auto& [curve, vertex] = edges_[edge];
        const Polygon& polygon = curves_[curve];
        const Point2 a = polygon[vertex], b = polygon[after(curve, vertex)];
        return turned_[curve] ? Segment2{b, a} : Segment2{a, b};
    }

    [[nodiscard]] std::size_t after(std::size_t curve, std::size_t vertex) const {
        return vertex + 1 == curves_[curve].size() ? 0 : vertex + 1;
    }

    void addEdges() {
        std::vector<Box2> boxes;
        for (std::size_t i = 0; i < curves_.size(); ++i)
            for (std::size_t k = 0; k < curves_[i].size(); ++k) {
                edges_.push_back({i, k});
                boxes.push_back(bounds(line(edges_.size() - 1)));
            }
        tree_ = BoxTree(boxes);
    }

    /// Links the vertices of each curve in a ring.
    void linkVertices() {
        for (const Polygon& curve : curves_) {
            const std::size_t first = points_.size();
            first_.push_back(first);
            points_.insert(points_.end(), curve.begin(), curve.end());
            for (std::size_t i = 1; i < curve.size(); ++i) next_.push_back(first + i);
            next_.push_back(first);
        }
    }

    /// Finds the nearest edge to the left of a cavity's leftmost vertex with the solid between;
    /// empty if there is none.
    [[nodiscard]] std::optional<Hit> surrounding(std::size_t cavity) const {
        const Point2 from = curves_[cavity].front();
        std::vector<Hit> hits;
        const Box2 window{{-std::numeric_limits<double>::infinity(), from.y}, from};
        tree_.search(window, [&](std::size_t edge) {
            const std::size_t curve = edges_[edge].curve;
            // Later curves may touch this one, but cannot surround it.
            if (curve == cavity || rank_[curve] > rank_[cavity]) return;
            const auto [a, b] = line(edge);
            if ((a.y > from.y) == (b.y > from.y)) return;
            const double x = std::clamp(a.x + (from.y - a.y) / (b.y - a.y) * (b.x - a.x),
                                        std::min(a.x, b.x), std::max(a.x, b.x));
            if (x <= from.x) hits.push_back({edge, {x, from.y}});
        });
        std::sort(hits.begin(), hits.end(), [](const Hit& s, const Hit& t) {
            return s.place.x != t.place.x ? s.place.x > t.place.x : s.edge < t.edge;
        });
        // The solid lies to the right of edges that go down. An edge that goes up is the right side
        // of a solid that begins further left.
        int beside = 0;
        for (const Hit& hit : hits) {
            const Segment2 s = line(hit.edge);
            if (s.a.y < s.b.y)
                ++beside;
            else if (beside-- == 0)
                return hit;
        }
        return std::nullopt;
    }

    void turn(std::size_t curve) {
        const std::size_t first = first_[curve];
        for (std::size_t i = 0; i < curves_[curve].size(); ++i)
            next_[first + after(curve, i)] = first + i;
        turned_[curve] = true;
        root_[curve] = true;
    }

    void splice(std::vector<Seam>& seams) {
        // Orders the seams of an edge along it.
        const auto way = [this](const Seam& seam) {
            return distance(line(seam.edge).a, seam.place);
        };
        std::stable_sort(seams.begin(), seams.end(), [&](const Seam& s, const Seam& t) {
            return s.edge != t.edge ? s.edge < t.edge : way(s) < way(t);
        });
        std::vector<std::size_t> head = first_;
        std::size_t edge = kNone, last = kNone;
        for (const Seam& seam : seams) {
            if (seam.edge != edge) {
                edge = seam.edge;
                const auto& [curve, vertex] = edges_[edge];
                const std::size_t from = turned_[curve] ? after(curve, vertex) : vertex;
                last = from == 0 ? head[curve] : first_[curve] + from;
            }
            // To a copy of the cavity's first vertex, around the cavity, and back from that vertex.
            const std::size_t begin = first_[seam.cavity];
            head[seam.cavity] = add(points_[begin], next_[begin]);
            const std::size_t back = add(seam.place, next_[last]);
            next_[begin] = back;
            next_[last] = add(seam.place, head[seam.cavity]);
            last = back;
        }
    }

    std::size_t add(Point2 point, std::size_t next) {
        points_.push_back(point);
        next_.push_back(next);
        return points_.size() - 1;
    }

    [[nodiscard]] Polygon collect(std::size_t first) const {
        Polygon out;
        std::size_t at = first;
        do {
            if (out.empty() || out.back() != points_[at]) out.push_back(points_[at]);
            at = next_[at];
        } while (at != first);
        while (out.size() > 1 && out.back() == out.front()) out.pop_back();
        beginAtLowest(out);
        return out;
    }

    std::vector<Polygon> curves_;
    std::vector<std::size_t> order_, rank_;  // from left to right
    std::vector<bool> root_, turned_;        // bounds a solid; has reversed edges
    std::vector<Edge> edges_;
    BoxTree tree_;
    std::vector<Point2> points_;
    std::vector<std::size_t> next_, first_;
};

}  // namespace

void beginAtLowest(Polygon& polygon) {
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end(), lexLess),
                polygon.end());
}

std::vector<Polygon> joinCavities(std::vector<Polygon> curves) {
    const bool has_cavity = std::any_of(curves.begin(), curves.end(),
                                        [](const Polygon& curve) { return signedArea(curve) < 0; });
    return has_cavity ? Seams(std::move(curves)).join() : curves;
}

}  // namespace ispace
