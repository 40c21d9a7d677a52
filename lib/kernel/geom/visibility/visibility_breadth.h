// SPDX-License-Identifier: GPL-3.0-or-later
// Private to VisibilityMap: the expansion of visibility_query.h, breadth first.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "geom/visibility/visibility.h"
#include "geom/visibility/visibility_mesh.h"
#include "geom/visibility/visibility_query.h"

namespace ispace {

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
