// SPDX-License-Identifier: GPL-3.0-or-later
// Private to VisibilityMap.
//
// Triangular expansion: F. Bungiu, M. Hemmer, J. Hershberger, K. Huang, A. Kröller, Efficient
// computation of visibility polygons, 2014. Windows are limited by vertices, never by constructed
// points, so that each decision is the orientation of three input points.
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

/// Directions of view that have reached the same portal: from the right limit of this window to
/// that of the next.
struct Window {
    Vec2 right;            ///< from the viewpoint to the corner of a portal
    std::uint32_t corner;  ///< that portal
    std::uint32_t next;    ///< the window on the left
    std::uint32_t target;  ///< the portal to pass, or the edge that blocks the view
};

/// A counter-clockwise chain of windows, and a queue of those still to expand. Uses the heap only
/// for the widest views.
class Windows {
  public:
    Windows() {}  // elements are uninitialised until used
    Windows(const Windows&) = delete;
    Windows& operator=(const Windows&) = delete;

    /// The pointers and counters, to be kept in registers.
    struct State {
        Window* windows;
        std::uint32_t* queue;
        std::uint32_t mask, count, head, tail;
        [[nodiscard]] bool isFull() const { return count + 8 > mask; }
    };
    [[nodiscard]] State state() const { return s_; }
    void setState(const State& s) { s_ = s; }
    [[nodiscard]] std::uint32_t count() const { return s_.count; }
    Window& operator[](std::uint32_t i) { return s_.windows[i]; }

    /// Appends a window at the left end of the chain.
    void append(const Window& window) {
        if (s_.isFull()) s_ = grow(s_);
        s_.windows[s_.count] = window;
        s_.windows[s_.count].next = s_.count + 1;
        ++s_.count;
    }
    void wait(std::uint32_t window) { s_.queue[s_.tail++ & s_.mask] = window; }

    /// Doubles the capacity. \return the new state
    [[nodiscard]] State grow(State s) {
        const std::uint32_t size = 2 * (s.mask + 1);
        std::vector<Window> windows(size);
        std::vector<std::uint32_t> queue(size);
        std::copy(s.windows, s.windows + s.count, windows.begin());
        for (std::uint32_t i = s.head; i != s.tail; ++i)
            queue[i & (size - 1)] = s.queue[i & s.mask];
        many_windows_.swap(windows);
        long_queue_.swap(queue);
        s.windows = many_windows_.data();
        s.queue = long_queue_.data();
        s.mask = size - 1;
        return s;
    }

  private:
    static constexpr std::uint32_t kHere = 256;  // a power of 2, as all sizes are
    union {
        Window windows_here[kHere];
    };
    union {
        std::uint32_t queue_here[kHere];
    };
    std::vector<Window> many_windows_;
    std::vector<std::uint32_t> long_queue_;
    State s_{windows_here, queue_here, kHere - 1, 0, 0, 0};
};

/// A query in a large mesh, in which branches are unpredictable and a misprediction costs more than
/// a step. So all windows advance in turn, one triangle each, without branches: the steps are
/// independent and overlap. The result is that of Expansion, to the last bit.
/// kBounded: some line may lie beyond the range; windows end at edges that lie beyond it as a
/// whole.
template <bool kBounded>
class BreadthFirst {
  public:
    using Index = std::uint32_t;

    /// \param search decides turns and writes edges
    BreadthFirst(const Portal* portals, Point2 viewpoint, double farthest,
                 Expansion<kBounded, false>& search)
        : portals_(portals),
          viewpoint_(viewpoint),
          sure_(errorOfTurns(farthest)),
          search_(search) {}

    [[nodiscard]] double turn(Index a, Index b) const { return search_.turn(a, b); }
    /// Through an edge of a triangle that holds the viewpoint. Edges follow each other
    /// counter-clockwise.
    void throughEdge(Index edge) {
        const Index target = within(portals_[beforeOf(edge)].right);
        windows_.append({search_.wayTo(nextOf(edge)), nextOf(edge), 0, target});
        if (isPortal(target) != 0) windows_.wait(windows_.count() - 1);
        left_corner_ = beforeOf(edge);
    }
    /// Expands through the edges given so far and writes the region.
    void run() {
        windows_.append({search_.wayTo(left_corner_), left_corner_, 0, Portal::kFree});
        const Index end = windows_.count() - 1;
        expand();
        for (Index i = 0; i != end;) {
            const Window& window = windows_[i];
            i = window.next;
            search_.stopAt(window.target, window.right, windows_[i].right);
        }
    }

  private:
    /// 1 or 0.
    static Index isPortal(Index target) { return target >> 31 ^ 1; }
    static_assert(Portal::kBlocked == Index{1} << 31 && Portal::kFree >> 31 == 1);

    /// The target, or kFree if that is a portal beyond the range.
    [[nodiscard]] Index within(Index target) const {
        return kBounded && isPortal(target) != 0 && search_.isBeyond(target) ? Portal::kFree
                                                                             : target;
    }

    template <Index kBatch>
    void advance(Windows::State& s) const;

    /// Expands all waiting windows until each is blocked.
    void expand() {
        // A local copy stays in registers in spite of all stores.
        Windows::State s = windows_.state();
        while (s.head != s.tail) {
            if (s.isFull()) [[unlikely]]
                s = windows_.grow(s);
            if (s.tail - s.head >= 4)
                advance<4>(s);
            else
                advance<1>(s);
        }
        windows_.setState(s);
    }

    const Portal* portals_;
    Point2 viewpoint_;
    double sure_;  // no cross product of two ways is wrong by more
    Expansion<kBounded, false>& search_;
    Index left_corner_ = 0;  // of the last window
    Windows windows_;
};

/// Advances kBatch waiting windows by one triangle each. All reads come before all writes, so that
/// no load waits for a store.
template <bool kBounded>
template <std::uint32_t kBatch>
ISPACE_INLINE void BreadthFirst<kBounded>::advance(Windows::State& s) const {
    Index here[kBatch], entered[kBatch], next[kBatch];
    double x[kBatch], y[kBatch], from_right[kBatch], from_left[kBatch];
    bool is_far[kBatch];
    bool is_sure = true, any_is_far = false;
#pragma GCC unroll 4
    for (Index i = 0; i < kBatch; ++i) {
        here[i] = s.queue[(s.head + i) & s.mask];
        const Window& window = s.windows[here[i]];
        entered[i] = window.target;
        next[i] = window.next;
        const Window& beyond = s.windows[next[i]];
        const Portal& portal = portals_[entered[i]];
        x[i] = portal.corner.x - viewpoint_.x;
        y[i] = portal.corner.y - viewpoint_.y;
        from_right[i] = window.right.x * y[i] - window.right.y * x[i];
        from_left[i] = beyond.right.x * y[i] - beyond.right.y * x[i];
        is_far[i] = kBounded && search_.isFar({x[i], y[i]});
        any_is_far |= is_far[i];
        is_sure &= std::min(std::abs(from_right[i]), std::abs(from_left[i])) > sure_;
    }
    s.head += kBatch;
    if (!is_sure) [[unlikely]] {
        for (Index i = 0; i < kBatch; ++i) {
            from_right[i] = search_.turn(s.windows[here[i]].corner, entered[i]);
            from_left[i] = search_.turn(s.windows[next[i]].corner, entered[i]);
        }
    }
    // Selects the direction to continue.
    const auto proceed = [&](Index i, auto within) {
        const Portal& portal = portals_[entered[i]];
        const Index goes_right = from_right[i] > 0, goes_left = from_left[i] < 0;
        const Index splits = goes_right & goes_left;
        Index left = portal.left, target = left ^ ((left ^ portal.right) & -goes_right);
        prefetch(portals_, target);
        prefetch(portals_, left);
        within(target);
        within(left);
        Window& window = s.windows[here[i]];
        window.target = target;
        window.next = next[i] ^ ((next[i] ^ s.count) & -splits);
        Window& spare = s.windows[s.count];
        spare.right.x = x[i];
        spare.right.y = y[i];
        spare.corner = entered[i];
        spare.next = next[i];
        spare.target = left;
        s.queue[s.tail & s.mask] = here[i];
        s.tail += isPortal(target);
        s.queue[s.tail & s.mask] = s.count;
        s.tail += splits & isPortal(left);
        s.count += splits;
    };
    if (kBounded && any_is_far) {
        for (Index i = 0; i < kBatch; ++i)
            proceed(i, [&](Index& target) {
                if (is_far[i]) target = within(target);
            });
        return;
    }
#pragma GCC unroll 4
    for (Index i = 0; i < kBatch; ++i) proceed(i, [](Index&) {});
}

}  // namespace ispace
