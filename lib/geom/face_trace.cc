// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of lines that meet at common ends only: the half-edges about each vertex in order, walked
// along. All decisions are exact.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

using Index = std::uint32_t;
constexpr Index kNone = std::numeric_limits<Index>::max();

/// Pairs of edges that are compared at most, per edge and besides: what lies closer together goes
/// to the sweep, which does not mind.
constexpr std::size_t kPairsPerEdge = 64, kPairsAnyway = 1U << 20;

/// From its lower end to its upper.
struct Edge {
    Point2 a, b;
    bool passage = false;
};

Point2 withoutNegativeZero(Point2 p) { return {p.x + 0.0, p.y + 0.0}; }

/// Each once, those without length left out; a passage on a line is none.
std::vector<Edge> edgesOf(std::span<const Segment2> lines, std::span<const Segment2> passages) {
    std::vector<Edge> edges;
    edges.reserve(lines.size() + passages.size());
    const auto add = [&edges](const Segment2& s, bool passage) {
        const Point2 a = withoutNegativeZero(s.a), b = withoutNegativeZero(s.b);
        if (a == b) return;
        edges.push_back(lexLess(a, b) ? Edge{a, b, passage} : Edge{b, a, passage});
    };
    for (const Segment2& s : lines) add(s, false);
    for (const Segment2& s : passages) add(s, true);
    std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& f) {
        if (e.a != f.a) return lexLess(e.a, f.a);
        if (e.b != f.b) return lexLess(e.b, f.b);
        return e.passage < f.passage;
    });
    edges.erase(std::unique(edges.begin(), edges.end(),
                            [](const Edge& e, const Edge& f) { return e.a == f.a && e.b == f.b; }),
                edges.end());
    return edges;
}

/// True if two different edges have no point in common but an end. \pre e.a is not above f.a
bool meetAtEndsOnly(const Edge& e, const Edge& f) {
    if (e.b.x < f.a.x || std::max(e.a.y, e.b.y) < std::min(f.a.y, f.b.y) ||
        std::max(f.a.y, f.b.y) < std::min(e.a.y, e.b.y))
        return true;
    // Beyond a common end one may run along the other.
    if (e.a == f.a || e.b == f.b)
        return orientation(e.a, e.b, e.a == f.a ? f.b : f.a) != Turn::Straight;
    if (e.b == f.a) return true;
    return !intersects({e.a, e.b}, {f.a, f.b});
}

/// True if all edges meet at common ends only, as far as that is quickly told.
bool meetAtEndsOnly(const std::vector<Edge>& edges, const SegmentGrid& grid) {
    std::size_t pairs_left = kPairsAnyway + kPairsPerEdge * edges.size();
    bool clean = true;
    grid.forEachCell([&](std::span<const Index> cell) {
        if (!clean) return;
        const std::size_t pairs = cell.size() * (cell.size() - 1) / 2;
        clean = pairs <= pairs_left;
        pairs_left -= clean ? pairs : 0;
        for (std::size_t i = 0; clean && i < cell.size(); ++i) {
            for (std::size_t k = i + 1; clean && k < cell.size(); ++k)
                clean = meetAtEndsOnly(edges[cell[i]], edges[cell[k]]);
        }
    });
    return clean;
}

/// The same by boxes of edges, which an uneven plan does not crowd as it does cells.
bool meetAtEndsOnly(const std::vector<Edge>& edges, const SegmentTree& tree) {
    std::size_t pairs_left = kPairsAnyway + kPairsPerEdge * edges.size();
    bool clean = true;
    for (std::size_t i = 0; clean && i < edges.size(); ++i)
        tree.search({edges[i].a, edges[i].b}, 0, [&](std::size_t k) {
            if (!clean || k <= i) return;
            clean = pairs_left > 0 && meetAtEndsOnly(edges[i], edges[k]);
            if (clean) --pairs_left;
        });
    return clean;
}

/// Half-edge 2i leads along edge i from its lower end to its upper, 2i + 1 back.
Index twin(Index half) { return half ^ 1U; }

/// What the edges divide the floor into.
class FaceTrace {
  public:
    FaceTrace(const std::vector<Edge>& edges, const SegmentGrid& grid)
        : edges_(edges), grid_(grid) {
        sortAroundVertices();
        dropDanglingEdges();
        linkHalfEdges();
        walkCycles();
        placeComponents();
        joinFaces();
    }

    [[nodiscard]] std::vector<Region> regions() {
        countBoundaries();
        std::vector<Region> regions(parent_.size());
        walked_.assign(2 * edges_.size(), false);
        for (const Index half : order_) {
            if (walked_[half] || !isBoundary(half)) continue;
            const std::vector<Index> loop = walkBoundary(half);
            Polygon curve = curveOf(loop);
            Region& region = regions[piece(half)];
            // What doubles cannot tell from a line has no area either.
            if (isOuter(loop)) {
                if (signedArea(curve) < 0) region.holes.push_back(std::move(curve));
            } else if (signedArea(curve) > 0) {
                region.outline = std::move(curve);
            }
        }
        putInOrder(regions);
        return regions;
    }

  private:
    [[nodiscard]] Point2 source(Index half) const {
        const Edge& edge = edges_[half / 2];
        return half % 2 == 0 ? edge.a : edge.b;
    }
    [[nodiscard]] Point2 target(Index half) const { return source(twin(half)); }

    /// Half-edges by source, about each counter-clockwise.
    void sortAroundVertices() {
        order_.resize(2 * edges_.size());
        std::iota(order_.begin(), order_.end(), Index{0});
        std::sort(order_.begin(), order_.end(), [this](Index g, Index h) {
            const Point2 p = source(g), q = source(h);
            if (p != q) return lexLess(p, q);
            // Even ones lead to the right or straight up, the others to the left or down.
            if (g % 2 != h % 2) return g % 2 < h % 2;
            return g != h && orientation(p, target(g), target(h)) == Turn::Left;
        });
        vertex_.resize(order_.size());
        Index vertices = 0;
        for (std::size_t i = 0; i < order_.size(); ++i) {
            if (i > 0 && source(order_[i]) != source(order_[i - 1])) ++vertices;
            vertex_[order_[i]] = vertices;
        }
        degree_.assign(order_.empty() ? 0 : vertices + 1, 0);
        for (const Index half : order_) ++degree_[vertex_[half]];
    }

    /// Edges with an end of their own bound nothing, nor do those that are left alone by that.
    void dropDanglingEdges() {
        std::vector<Index> left = degree_;
        std::vector<Index> first(degree_.size() + 1, 0);
        for (std::size_t v = 0; v < degree_.size(); ++v) first[v + 1] = first[v] + degree_[v];
        dropped_.assign(edges_.size(), false);
        std::vector<Index> loose;
        for (Index v = 0; v < left.size(); ++v) {
            if (left[v] == 1) loose.push_back(v);
        }
        while (!loose.empty()) {
            const Index v = loose.back();
            loose.pop_back();
            for (Index i = first[v]; i < first[v + 1]; ++i) {
                const Index half = order_[i], other = vertex_[twin(half)];
                if (dropped_[half / 2]) continue;
                dropped_[half / 2] = true;
                if (--left[other] == 1) loose.push_back(other);
                break;  // it had one only
            }
        }
        std::erase_if(order_, [this](Index half) { return dropped_[half / 2]; });
    }

    /// The edge after u -> v on the way around the face to its left: at v the next one clockwise
    /// from that back to u.
    void linkHalfEdges() {
        next_.assign(2 * edges_.size(), kNone);
        for (std::size_t from = 0, to = 0; from < order_.size(); from = to) {
            while (to < order_.size() && vertex_[order_[to]] == vertex_[order_[from]]) ++to;
            for (std::size_t i = from; i < to; ++i)
                next_[twin(order_[i])] = order_[i == from ? to - 1 : i - 1];
        }
    }

    /// Cycles of half-edges: around a face each, or around all that hangs together.
    void walkCycles() {
        cycle_.assign(2 * edges_.size(), kNone);
        std::vector<Index> cycle;
        for (const Index start : order_) {
            if (cycle_[start] != kNone) continue;
            cycle.clear();
            const auto number = static_cast<Index>(face_of_cycle_.size());
            for (Index half = start; cycle_[half] == kNone; half = next_[half]) {
                cycle_[half] = number;
                cycle.push_back(half);
            }
            const bool outer = isOuter(cycle);
            face_of_cycle_.push_back(outer ? kNone : faces_++);
            // The walk starts at half-edges in the order of their sources.
            if (outer) outer_.push_back(start);
        }
    }

    /// Finds the face in which each component lies, from left to right.
    void placeComponents() {
        for (std::size_t i = 1; i < outer_.size(); ++i) {
            const Index below = halfEdgeBelow(source(outer_[i]));
            if (below == kNone) continue;
            face_of_cycle_[cycle_[outer_[i]]] = face_of_cycle_[cycle_[below]];
        }
    }

    /// The half-edge with the place just to the left of p right above it, or none. \pre p is the
    /// lowest vertex of its component
    [[nodiscard]] Index halfEdgeBelow(Point2 p) const {
        Index best = kNone;
        grid_.searchBelow(p, [&](std::span<const Index> cell, double bottom) {
            for (const Index i : cell) {
                const Edge& edge = edges_[i];
                if (dropped_[i] || !(edge.a.x < p.x && p.x <= edge.b.x)) continue;
                if (orientation(edge.a, edge.b, p) != Turn::Left) continue;
                if (best == kNone || (i != best && isAbove(edge, edges_[best]))) best = i;
            }
            if (best == kNone) return false;
            const Edge& edge = edges_[best];
            const double share = (p.x - edge.a.x) / (edge.b.x - edge.a.x);
            return edge.a.y + share * (edge.b.y - edge.a.y) > bottom;
        });
        return best == kNone ? kNone : 2 * best;
    }

    /// Which of two edges over a common stretch of x is the upper one.
    static bool isAbove(const Edge& e, const Edge& f) {
        if (lexLess(e.a, f.a)) return !isAbove(f, e);
        return orientation(f.a, f.b, e.a == f.a ? e.b : e.a) == Turn::Left;
    }

    void joinFaces() {
        parent_.resize(faces_);
        std::iota(parent_.begin(), parent_.end(), Index{0});
        for (Index i = 0; i < edges_.size(); ++i) {
            if (!edges_[i].passage || dropped_[i]) continue;
            const Index left = face(2 * i), right = face(2 * i + 1);
            if (left == kNone || right == kNone) continue;
            const Index a = root(left), b = root(right);
            parent_[std::max(a, b)] = std::min(a, b);
        }
        for (Index& parent : parent_) parent = root(parent);
    }

    [[nodiscard]] Index root(Index face) {
        while (parent_[face] != face) {
            parent_[face] = parent_[parent_[face]];
            face = parent_[face];
        }
        return face;
    }

    /// The face on the left; none: the outside.
    [[nodiscard]] Index face(Index half) const { return face_of_cycle_[cycle_[half]]; }

    /// The same, joined faces being one.
    [[nodiscard]] Index piece(Index half) const {
        return face(half) == kNone ? kNone : parent_[face(half)];
    }

    [[nodiscard]] bool isBoundary(Index half) const {
        const Index left = piece(half);
        return left != kNone && left != piece(twin(half));
    }

    void countBoundaries() {
        boundaries_.assign(degree_.size(), 0);
        for (const Index half : order_) {
            if (isBoundary(half) || isBoundary(twin(half))) ++boundaries_[vertex_[half]];
        }
    }

    /// A closed walk along the boundary of a piece, the piece on the left.
    [[nodiscard]] std::vector<Index> walkBoundary(Index start) {
        std::vector<Index> loop;
        Index half = start;
        do {
            walked_[half] = true;
            loop.push_back(half);
            half = next_[half];
            // Lines with the same piece on both sides are no boundary: turn past them.
            while (!isBoundary(half)) half = next_[twin(half)];
        } while (half != start);
        return loop;
    }

    /// Whether what is on the left lies outside the loop: at one of the loop's visits to its
    /// leftmost vertex the direction to the left is on its left.
    [[nodiscard]] bool isOuter(const std::vector<Index>& loop) const {
        const Index leftmost =
            vertex_[*std::min_element(loop.begin(), loop.end(), [this](Index g, Index h) {
                return vertex_[g] < vertex_[h];
            })];
        for (std::size_t i = 0; i < loop.size(); ++i) {
            if (vertex_[loop[i]] != leftmost) continue;
            const Index before = loop[i == 0 ? loop.size() - 1 : i - 1];
            if (orientation(source(loop[i]), source(before), target(loop[i])) == Turn::Left)
                return true;
        }
        return false;
    }

    /// The loop's vertices without those that only lines of no account made, from the lowest.
    [[nodiscard]] Polygon curveOf(const std::vector<Index>& loop) const {
        Polygon curve;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Index before = loop[i == 0 ? loop.size() - 1 : i - 1], half = loop[i];
            const Index vertex = vertex_[half];
            const Point2 p = source(half);
            if (degree_[vertex] != 2 && boundaries_[vertex] == 2 &&
                orientation(source(before), p, target(half)) == Turn::Straight)
                continue;
            curve.push_back(p);
        }
        if (curve.size() < 3) return {};
        rotateToLowest(curve);
        return curve;
    }

    const std::vector<Edge>& edges_;
    const SegmentGrid& grid_;
    std::vector<Index> order_;   // half-edges by vertex, counter-clockwise
    std::vector<Index> vertex_;  // where each half-edge begins; vertices are numbered in order
    std::vector<Index> degree_;  // of each vertex, with dangling edges
    std::vector<bool> dropped_;  // edges
    std::vector<Index> next_;    // half-edges
    std::vector<Index> cycle_;   // of each half-edge
    std::vector<Index> face_of_cycle_;
    Index faces_ = 0;
    std::vector<Index> outer_;   // a half-edge of each component that begins at its lowest vertex
    std::vector<Index> parent_;  // of each face: union of joined ones
    std::vector<Index> boundaries_;  // edges at each vertex
    std::vector<bool> walked_;
};

}  // namespace

std::optional<std::vector<Region>> tracedFaces(std::span<const Segment2> lines,
                                               std::span<const Segment2> passages) {
    const std::vector<Edge> edges = edgesOf(lines, passages);
    std::vector<Segment2> segments;
    segments.reserve(edges.size());
    for (const Edge& edge : edges) segments.push_back({edge.a, edge.b});
    const SegmentGrid grid(segments, 0);
    if (!meetAtEndsOnly(edges, grid) && !meetAtEndsOnly(edges, SegmentTree(segments)))
        return std::nullopt;
    return FaceTrace(edges, grid).regions();
}

}  // namespace ispace
