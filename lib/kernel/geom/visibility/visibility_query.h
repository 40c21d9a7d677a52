// SPDX-License-Identifier: GPL-3.0-or-later
// Private to VisibilityMap.
//
// Triangular expansion: F. Bungiu, M. Hemmer, J. Hershberger, K. Huang, A. Kröller, Efficient
// computation of visibility polygons, 2014. Windows are limited by vertices, never by constructed
// points, so that each decision is the orientation of three input points: a filter with the bound
// of the longest way (errorOfTurns), orientation() where that fails. Ends of edges are constructed
// last and decide no turn: each errs by some ulp of the wall's coordinates, and is exact at its
// ends.
//
// A query visits each triangle that the view enters, once for each window into it: O(n) triangles
// in a room without free-standing walls, O(n h) at worst with h of them; typically a few for each
// edge of the region. No allocation beyond the region's own for up to 64 pending windows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/simd.h"
#include "geom/visibility/visibility.h"
#include "geom/visibility/visibility_mesh.h"

namespace ispace {

/// Collects the edges of the region, counter-clockwise; inline, as it is much of the work of a
/// query.
class EdgeWriter {
  public:
    EdgeWriter(Point2 viewpoint, double range, std::vector<VisibilityEdge>& edges)
        : viewpoint_(viewpoint), range_(range), edges_(edges) {}

    ISPACE_INLINE void addLine(std::uint32_t line, Point2 from, Point2 to) {
        if (has_arc_) flushArc();
        if (!edges_.empty()) {
            VisibilityEdge& last = edges_.back();
            if (last.line == line && last.to == from &&
                cross(last.from - viewpoint_, to - viewpoint_) > 0) {
                last.to = to;
                return;
            }
        }
        // Else the edge has no width in doubles.
        if (cross(from - viewpoint_, to - viewpoint_) > 0) edges_.push_back({from, to, line});
    }

    /// The view is free from one direction to another, less than a half turn on.
    void addFree(Vec2 from, Vec2 to) {
        const bool is_wide = dot(from, to) < 0;
        if (!is_wide && !(cross(from, to) > 0)) return;
        if (!has_arc_) arc_from_ = from;
        has_arc_ = true;
        // Up to here, a quarter turn at most was open: now it is less than three.
        const bool is_almost_three = is_wide && dot(arc_from_, to) >= 0 && cross(arc_from_, to) < 0;
        if (is_almost_three) addQuarter();
        for (int i = 0; i < 2 && dot(arc_from_, to) < 0; ++i) addQuarter();
        arc_to_ = to;
    }

    void finish() {
        if (has_arc_) flushArc();
        if (edges_.size() < 2) return;
        VisibilityEdge& first = edges_.front();
        const VisibilityEdge& last = edges_.back();
        if (first.line != last.line || last.to != first.from) return;
        const Vec2 from = last.from - viewpoint_, to = first.to - viewpoint_;
        if (!(cross(from, to) > 0)) return;
        if (first.line == VisibilityEdge::kArc && dot(from, to) < 0) return;
        first.from = last.from;
        edges_.pop_back();
    }

  private:
    [[nodiscard]] Point2 onCircle(Vec2 direction) const {
        // In two steps: the square of a very short distance may underflow.
        const double size = std::max(std::abs(direction.x), std::abs(direction.y));
        const Vec2 scaled{direction.x / size, direction.y / size};
        return viewpoint_ + (range_ / std::sqrt(dot(scaled, scaled))) * scaled;
    }
    void addArc(Vec2 from, Vec2 to) {
        const Point2 a = onCircle(from), b = onCircle(to);
        if (cross(a - viewpoint_, b - viewpoint_) > 0)
            edges_.push_back({a, b, VisibilityEdge::kArc});
    }
    void addQuarter() {
        const Vec2 to = perpendicular(arc_from_);
        addArc(arc_from_, to);
        arc_from_ = to;
    }
    void flushArc() {
        addArc(arc_from_, arc_to_);
        has_arc_ = false;
    }

    Point2 viewpoint_;
    double range_;
    std::vector<VisibilityEdge>& edges_;
    bool has_arc_ = false;  // begun, not yet written
    Vec2 arc_from_, arc_to_;
};

/// Prefetches a target; harmless if it is not a portal.
inline void prefetch(const Portal* portals, std::uint32_t target) {
    // The address may lie beyond the portals; it is only prefetched.
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(portals) +
                                                     target * sizeof(Portal)));
}

/// Two numbers, for the right and the left limit; selecting between pairs is branch-free.
using Pair = double __attribute__((vector_size(16)));

struct PairOfPoints {
    Pair x, y;
};

/// Where rays along the limits cross the segment from a to b, as fractions of it; a is on their
/// right or on them (exactly 0 if it is a limit itself), b on their left or on them (exactly 1).
ISPACE_INLINE Pair crossings(Pair limits_x, Pair limits_y, Vec2 a, Vec2 b) {
    const Pair right = a.x * limits_y - a.y * limits_x, left = limits_x * b.y - limits_y * b.x;
    const Pair share = right / (right + left), zero{}, one{1, 1};
    // Rounding may lead out; 0 / 0 gives 0.
    const Pair above = share > zero ? share : zero;
    return above < one ? above : one;
}

/// The points at these fractions of the segment, measured from the nearer end: exact at both ends.
ISPACE_INLINE PairOfPoints between(const Segment2& s, Pair share) {
    const Vec2 way = s.b - s.a;
    const Pair half{0.5, 0.5};
    const auto near_a = share < half;
    const Pair from_x = near_a ? Pair{s.a.x, s.a.x} : Pair{s.b.x, s.b.x};
    const Pair from_y = near_a ? Pair{s.a.y, s.a.y} : Pair{s.b.y, s.b.y};
    const Pair part = near_a ? share : share - 1;
    return {from_x + part * way.x, from_y + part * way.y};
}

/// A pending view to the left of a portal's corner; everything to its right is expanded first.
struct Pending {
    std::uint32_t target;       ///< portal or blocking edge
    std::uint32_t corner;       ///< portal at the corner of the right limit
    std::uint32_t left_vertex;  ///< portal at the corner of the left limit
    Vec2 right, left;           ///< the limits, from the viewpoint
};

/// A stack with inline storage, which seldom overflows to the heap.
class PendingStack {
  public:
    [[nodiscard]] bool empty() const { return top_ == base_; }
    void push(const Pending& pending) {
        if (top_ == end_) grow();
        *top_++ = pending;
    }
    const Pending& pop() { return *--top_; }
    void reverse() { std::reverse(base_, top_); }

  private:
    void grow() {
        const auto count = static_cast<std::size_t>(top_ - base_);
        std::vector<Pending> larger(2 * count);
        std::copy(base_, top_, larger.begin());
        heap_.swap(larger);
        base_ = heap_.data();
        top_ = base_ + count;
        end_ = base_ + heap_.size();
    }

    static constexpr std::size_t kHere = 64;
    union {
        Pending here[kHere];  // uninitialised until used
    };
    std::vector<Pending> heap_;
    Pending *base_ = here, *top_ = base_, *end_ = base_ + kHere;

  public:
    PendingStack() {}
};

/// A query, depth first. kBounded: some line may lie beyond the range. kTouches: some lines are
/// transparent.
template <bool kBounded, bool kTouches>
class Expansion {
  public:
    using Index = std::uint32_t;

    /// \param farthest no corner is farther from the viewpoint
    Expansion(const Portal* portals, Point2 viewpoint, double range, double farthest,
              std::span<const Index> transparent, std::vector<VisibilityEdge>& edges)
        : portals_(portals),
          viewpoint_(viewpoint),
          squared_range_(range * range),
          sure_(errorOfTurns(farthest)),
          transparent_(transparent),
          out_(viewpoint, range, edges) {}

    /// Through an edge of a triangle that holds the viewpoint. Edges follow each other
    /// counter-clockwise.
    void throughEdge(Index edge) {
        begin(portals_[beforeOf(edge)].right, nextOf(edge), beforeOf(edge));
    }
    /// From outside of all triangles; in the same order.
    void throughPortal(Index portal) { begin(portal, beforeOf(portal), nextOf(portal)); }

    /// Expands through all edges and portals given so far and writes the region.
    void run();

    /// Writes the line, or kFree, that bounds the view between two limits, counter-clockwise.
    void stopAt(Index target, const Vec2& right, const Vec2& left);
    EdgeWriter& out() { return out_; }

    [[nodiscard]] Vec2 wayTo(Index portal) const { return portals_[portal].corner - viewpoint_; }

    /// Above 0 if the corner of portal b lies to the left of that of a.
    [[nodiscard]] double turn(Index a, Index b) const {
        const double turn = surelyTurns(wayTo(a), wayTo(b));
        if (turn != 0) [[likely]]
            return turn;
        return static_cast<int>(orientation(viewpoint_, portals_[a].corner, portals_[b].corner));
    }

    /// Whether a corner lies beyond the range, and whether all of an edge does: then both of its
    /// ends do.
    [[nodiscard]] bool isFar(Vec2 way) const { return squaredLength(way) > squared_range_; }
    [[nodiscard]] bool isBeyond(Index edge) const;

  private:
    static double square(double x) { return x * x; }
    static double squaredLength(Vec2 v) { return dot(v, v); }

    /// A vertex that limits the view.
    struct Limit {
        Index portal;  ///< its corner is the vertex
        Vec2 way;      ///< to the vertex
    };

    void begin(Index target, Index right, Index left) {
        pending_.push({passed(target), right, left, wayTo(right), wayTo(left)});
    }

    /// The target behind transparent lines.
    [[nodiscard]] Index passed(Index target) const {
        if (!kTouches || target < Portal::kBlocked || target == Portal::kFree) return target;
        const Index edge = target - Portal::kBlocked;
        const bool is_transparent =
            std::binary_search(transparent_.begin(), transparent_.end(), edge);
        return is_transparent ? portals_[edge].behind : target;
    }

    void stopWithinRange(Index line, const Segment2& wall, Pair shares, const Vec2& right,
                         const Vec2& left);

    const Portal* portals_;
    Point2 viewpoint_;
    double squared_range_;
    double sure_;                         // no cross product of two ways is wrong by more
    std::span<const Index> transparent_;  // edges, both sides of each, ascending
    EdgeWriter out_;
    PendingStack pending_;
};

template <bool kBounded, bool kTouches>
void Expansion<kBounded, kTouches>::run() {
    pending_.reverse();  // the rightmost one first
    while (!pending_.empty()) {
        const Pending& next = pending_.pop();
        Index target = next.target;
        const Limit right{next.corner, next.right};
        Limit left{next.left_vertex, next.left};
        // Whether the end points of the edge may both lie beyond the range.
        bool may_be_beyond = kBounded && isFar(right.way);
        while (target < Portal::kBlocked && !(may_be_beyond && isBeyond(target))) {
            const Portal& portal = portals_[target];
            const Limit corner{target, portal.corner - viewpoint_};
            if (kBounded) may_be_beyond = isFar(corner.way);
            // Both possible targets.
            prefetch(portals_, portal.left);
            prefetch(portals_, portal.right);
            double from_right = cross(right.way, corner.way);
            double from_left = cross(left.way, corner.way);
            if (!(std::min(std::abs(from_right), std::abs(from_left)) > sure_)) [[unlikely]] {
                from_right = turn(right.portal, target);
                from_left = turn(left.portal, target);
            }
            if (!(from_right > 0)) {
                target = passed(portal.left);
                continue;
            }
            if (from_left < 0) {
                // Both: the left one waits.
                pending_.push({passed(portal.left), target, left.portal, corner.way, left.way});
                left = corner;
            }
            target = passed(portal.right);
        }
        stopAt(target < Portal::kBlocked ? Portal::kFree : target, right.way, left.way);
    }
}

template <bool kBounded, bool kTouches>
bool Expansion<kBounded, kTouches>::isBeyond(Index edge) const {
    const Vec2 a = wayTo(nextOf(edge)), b = wayTo(beforeOf(edge)), along = b - a;
    const bool ends_are = std::min(squaredLength(a), squaredLength(b)) > squared_range_;
    const bool end_is_nearest = std::max(dot(a, along), -dot(b, along)) >= 0;
    const bool line_is = square(cross(a, b)) >= squared_range_ * squaredLength(along);
    return ends_are & (end_is_nearest | line_is);
}

template <bool kBounded, bool kTouches>
ISPACE_INLINE void Expansion<kBounded, kTouches>::stopAt(Index target, const Vec2& right,
                                                         const Vec2& left) {
    if (target == Portal::kFree) {
        out_.addFree(right, left);
        return;
    }
    const Index edge = target - Portal::kBlocked, line = portals_[edge].line;
    const Point2 &from = portals_[nextOf(edge)].corner, &to = portals_[beforeOf(edge)].corner;
    const Segment2 wall{{from.x, from.y}, {to.x, to.y}};
    const Vec2 a = wall.a - viewpoint_, b = wall.b - viewpoint_;
    const Pair shares = crossings(Pair{right.x, left.x}, Pair{right.y, left.y}, a, b);
    if (kBounded && std::max(squaredLength(a), squaredLength(b)) > squared_range_) {
        stopWithinRange(line, wall, shares, right, left);
        return;
    }
    const PairOfPoints ends = between(wall, shares);
    out_.addLine(line, {ends.x[0], ends.y[0]}, {ends.x[1], ends.y[1]});
}

/// The same for a wall that does not lie within the range as a whole.
template <bool kBounded, bool kTouches>
void Expansion<kBounded, kTouches>::stopWithinRange(Index line, const Segment2& wall, Pair shares,
                                                    const Vec2& right, const Vec2& left) {
    const Vec2 a = wall.a - viewpoint_, b = wall.b - viewpoint_, along = b - a;
    const double from = shares[0], to = shares[1];
    // Where the line through the wall is nearest, and within the range, as fractions of the wall.
    const double squared_length = squaredLength(along);
    const double room = squared_range_ - square(cross(a, b)) / squared_length;
    const double middle = -dot(a, along) / squared_length;
    const double half = room > 0 ? std::sqrt(room / squared_length) : 0;
    const double first = std::max(from, middle - half), last = std::min(to, middle + half);
    if (!(first < last)) {
        out_.addFree(right, left);
        return;
    }
    const PairOfPoints ends = between(wall, Pair{first, last});
    const Point2 begin{ends.x[0], ends.y[0]}, end{ends.x[1], ends.y[1]};
    if (first > from) out_.addFree(right, begin - viewpoint_);
    out_.addLine(line, begin, end);
    if (last < to) out_.addFree(end - viewpoint_, left);
}

}  // namespace ispace
