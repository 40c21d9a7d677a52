// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_fan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "base/simd.h"
#include "trace/flat_contact.h"
#include "trace/flat_line.h"
#include "trace/flat_round.h"

namespace ispace {

namespace {

constexpr int kWidth = FlatTree::kWidth;
constexpr int kBlock = FlatFan::kBlock;
constexpr double kTurn = 2 * std::numbers::pi;
/// Beams within this angle of a line's ends are looked at, in radians: more than kFlatEdgeAngle and
/// what angleOf() and the directions err.
constexpr double kSlack = 2.5e-5;

/// Direction of (x, y) in [-pi, pi], within 1e-5; 0 for the null vector (Abramowitz &
/// Stegun, 4.4.47 and the quadrants).
ISPACE_INLINE double angleOf(double x, double y) {
    const double far = std::fabs(x), wide = std::fabs(y);
    const double ratio = flatLess(far, wide) / flatMore(flatMore(far, wide), 1e-300);
    const double square = ratio * ratio;
    const double octant =
        ratio *
        (0.9998660 +
         square * (-0.3302995 + square * (0.1801410 + square * (-0.0851330 + square * 0.0208351))));
    // Only constants are chosen between: that leaves no branches.
    const bool is_steep = wide > far, is_behind = x < 0;
    const double quarter =
        (is_steep ? std::numbers::pi / 2 : 0.0) + (is_steep ? -1.0 : 1.0) * octant;
    const double half = (is_behind ? std::numbers::pi : 0.0) + (is_behind ? -1.0 : 1.0) * quarter;
    return std::copysign(half, y);
}

/// What of a fan the loops over lanes need.
struct Frame {
    double cos, sin, rate, middle, count;
    explicit Frame(const FlatFan& fan)
        : cos(fan.cos),
          sin(fan.sin),
          rate(fan.rate),
          middle((fan.count - 1) * 0.5),
          count(fan.count) {}
    /// The number of beams before this angle, and a fraction.
    [[nodiscard]] ISPACE_INLINE double beam(double angle) const {
        return flatLess(flatMore(angle * rate + middle + 1, 0.0), count);
    }
};

/// Beams of a fan, first > last if none; an angle behind the middle of the fan cuts the turn, so
/// that there may be others at its other end.
struct alignas(64) Spans {
    std::int32_t first[kWidth], last[kWidth], other_first[kWidth], other_last[kWidth];

    /// Those between directions a and b less than half a turn apart, counter-clockwise.
    ISPACE_INLINE void set(const Frame& frame, const double* ax, const double* ay, const double* bx,
                           const double* by) {
        double low[kWidth], high[kWidth], other_low[kWidth], other_high[kWidth];
        ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
            const double from = angleOf(ax[i] * frame.cos + ay[i] * frame.sin,
                                        ay[i] * frame.cos - ax[i] * frame.sin);
            const double end = angleOf(bx[i] * frame.cos + by[i] * frame.sin,
                                       by[i] * frame.cos - bx[i] * frame.sin);
            // By half a turn at least, or it is rounding.
            const double whole = end < from - 1 ? kTurn : 0.0;
            const double begin = from - kSlack, stop = end + whole + kSlack;
            const double back = begin < -std::numbers::pi ? kTurn : 1e9;
            const double shift = stop > std::numbers::pi ? -kTurn : back;
            low[i] = frame.beam(begin);
            high[i] = frame.beam(stop);
            other_low[i] = frame.beam(begin + shift);
            other_high[i] = frame.beam(stop + shift);
        }
        ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
            first[i] = static_cast<std::int32_t>(low[i]);
            last[i] = static_cast<std::int32_t>(high[i]) - 1;
            other_first[i] = static_cast<std::int32_t>(other_low[i]);
            other_last[i] = static_cast<std::int32_t>(other_high[i]) - 1;
        }
    }
};

/// A node or leaf to be visited, and the blocks of beams it may shorten.
struct Waiting {
    double nearness;
    std::int32_t child;
    std::int16_t first, last, other_first, other_last;
};

ISPACE_INLINE bool isSeen(const FlatFan& fan, int first, int last, double nearness) {
    for (int block = first; block <= last; ++block)
        if (fan.least[block] <= nearness) return true;
    return false;
}

ISPACE_INLINE bool isSeen(const FlatFan& fan, const Waiting& box) {
    return isSeen(fan, box.first, box.last, box.nearness) ||
           isSeen(fan, box.other_first, box.other_last, box.nearness);
}

/// Lines of a leaf, a component an array.
struct alignas(64) Lines {
    double ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth], ux[kWidth], uy[kWidth];
    double nearest[kWidth], height[kWidth], edge[kWidth], stops[kWidth];
    Spans spans;

    ISPACE_INLINE FlatLine operator[](int i) const {
        return {ax[i], ay[i], bx[i], by[i], ux[i], uy[i], nearest[i], height[i], edge[i], true};
    }
};

/// Draws a line into a block; returns the least nearness of it.
template <bool kCosines>
ISPACE_INLINE double drawBlock(FlatFan& fan, int block, const FlatLine& line) {
    const std::ptrdiff_t begin = std::ptrdiff_t{block} * kBlock;
    const double* const x = fan.x + begin;
    const double* const y = fan.y + begin;
    double* const nearness = fan.nearness + begin;
    double* const cosine = fan.cosine + begin;
    double least[kBlock];
    ISPACE_LANES for (int i = 0; i < kBlock; ++i) {
        const double here = nearnessAlong(line, x[i], y[i]);
        const double old = nearness[i];
        if constexpr (kCosines) {
            const double incidence = here * line.height;
            const double tied = flatChoice(here == old, flatMore(incidence, cosine[i]), cosine[i]);
            cosine[i] = flatChoice(here > old, incidence, tied);
        }
        least[i] = flatMore(here, old);
        nearness[i] = least[i];
    }
    double four[4];
    for (int i = 0; i < 4; ++i) four[i] = flatLess(least[i], least[i + 4]);
    return flatLess(flatLess(four[0], four[2]), flatLess(four[1], four[3]));
}

template <bool kCosines>
ISPACE_INLINE void drawSpan(FlatFan& fan, int first, int last, const FlatLine& line) {
    for (int block = first / kBlock; block <= last / kBlock; ++block)
        if (fan.least[block] <= line.nearest)
            fan.least[block] = drawBlock<kCosines>(fan, block, line);
}

template <bool kCosines>
ISPACE_INLINE void drawLeaf(const FlatTree& tree, const FlatView& view, const FlatTree::Leaf& leaf,
                            const Frame& frame, FlatFan& fan) {
    Lines lines;
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        const FlatLine line = lineFrom(leaf, i, view.x, view.y);
        lines.ax[i] = line.ax;
        lines.ay[i] = line.ay;
        lines.bx[i] = line.bx;
        lines.by[i] = line.by;
        lines.ux[i] = line.ux;
        lines.uy[i] = line.uy;
        lines.nearest[i] = line.nearest;
        lines.height[i] = line.height;
        lines.edge[i] = line.edge;
        lines.stops[i] = line.stops ? 1.0 : 0.0;
    }
    lines.spans.set(frame, lines.ax, lines.ay, lines.bx, lines.by);
    const Spans& spans = lines.spans;
    for (int i = 0; i < leaf.count; ++i) {
        const bool plain = spans.first[i] <= spans.last[i];
        const bool other = spans.other_first[i] <= spans.other_last[i];
        if (lines.stops[i] == 0 || (!plain && !other)) continue;
        if (mayContinueContact(lines.height[i], view.contact) &&
            continuesContact(tree, leaf, i, view.x, view.y, view.contact))
            continue;
        const FlatLine line = lines[i];
        if (plain) drawSpan<kCosines>(fan, spans.first[i], spans.last[i], line);
        if (other) drawSpan<kCosines>(fan, spans.other_first[i], spans.other_last[i], line);
    }
}

/// Draws a round body into blocks of beams.
template <bool kCosines>
void drawRound(FlatFan& fan, int first, int last, double nearest, const RoundFrom& round) {
    for (int block = first; block <= last; ++block) {
        if (fan.least[block] > nearest) continue;
        double least = 1e300;
        for (int i = block * kBlock; i < (block + 1) * kBlock; ++i) {
            const RoundFrom::Hit met = round.meet<kCosines>(fan.x[i], fan.y[i]);
            const double old = fan.nearness[i];
            if (kCosines && met.nearness >= old)
                fan.cosine[i] =
                    met.nearness > old ? met.cosine : std::max(met.cosine, fan.cosine[i]);
            fan.nearness[i] = std::max(met.nearness, old);
            least = std::min(least, fan.nearness[i]);
        }
        fan.least[block] = least;
    }
}

struct Stack {
    Waiting entries[FlatTree::kStack];
    int count = 0;
};

/// Puts those children on the stack that may shorten beams, the nearest on top.
ISPACE_INLINE void visit(const FlatTree::Node& node, const FlatView& view, const Frame& frame,
                         const FlatFan& fan, Stack& stack) {
    alignas(64) double nearness[kWidth];
    alignas(64) double ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth];
    Spans spans;
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        const double left = node.left[i] - view.x, right = node.right[i] - view.x;
        const double low = node.low[i] - view.y, high = node.high[i] - view.y;
        nearness[i] = 1 / distanceOf(left, right, low, high);
        // The corners between which the box is seen.
        const bool above = low > 0, below = high<0, east = left> 0, west = right < 0;
        ax[i] = above ? right : (below ? left : (east ? left : right));
        bx[i] = above ? left : (below ? right : (east ? left : right));
        ay[i] = east ? low : (west ? high : (above ? low : high));
        by[i] = east ? high : (west ? low : (above ? low : high));
    }
    spans.set(frame, ax, ay, bx, by);
    const int bottom = stack.count;
    for (int i = 0; i < node.count; ++i) {
        Waiting next{};
        next.nearness = nearness[i];
        next.child = node.child[i];
        const bool around = nearness[i] > 1e300;
        const bool plain = spans.first[i] <= spans.last[i];
        const bool other = spans.other_first[i] <= spans.other_last[i];
        if (!around && !plain && !other) continue;
        const auto block = [](int beam) { return static_cast<std::int16_t>(beam / kBlock); };
        next.first = around ? std::int16_t{0} : block(spans.first[i]);
        next.last = around ? block(fan.count - 1)
                           : static_cast<std::int16_t>(plain ? block(spans.last[i]) : -1);
        next.other_first = block(spans.other_first[i]);
        next.other_last = static_cast<std::int16_t>(other ? block(spans.other_last[i]) : -1);
        if (!isSeen(fan, next)) continue;
        int place = stack.count++;
        for (; place > bottom && stack.entries[place - 1].nearness > next.nearness; --place)
            stack.entries[place] = stack.entries[place - 1];
        stack.entries[place] = next;
    }
}

template <bool kCosines>
ISPACE_INLINE void drawTree(const FlatTree& tree, const FlatView& view, FlatFan& fan) {
    if (tree.nodes.empty()) return;
    const Frame frame(fan);
    Stack stack;
    visit(tree.nodes.front(), view, frame, fan, stack);
    while (stack.count > 0) {
        const Waiting box = stack.entries[--stack.count];
        if (!isSeen(fan, box)) continue;
        if (box.child >= 0)
            visit(tree.node(box.child), view, frame, fan, stack);
        else
            drawLeaf<kCosines>(tree, view, tree.leaf(box.child), frame, fan);
    }
    if (tree.round_root < 0) return;
    visit(tree.node(tree.round_root), view, frame, fan, stack);
    while (stack.count > 0) {
        const Waiting box = stack.entries[--stack.count];
        if (!isSeen(fan, box)) continue;
        if (box.child >= 0) {
            visit(tree.node(box.child), view, frame, fan, stack);
            continue;
        }
        const RoundFrom round(tree.round(box.child), view.x, view.y, view.contact);
        drawRound<kCosines>(fan, box.first, box.last, box.nearness, round);
        drawRound<kCosines>(fan, box.other_first, box.other_last, box.nearness, round);
    }
}

}  // namespace

void FlatFan::begin(double step_radians, double least_nearness) {
    const int i = (count - 1) / 2, j = count / 2;
    cos = x[i] + x[j];
    sin = y[i] + y[j];
    rate = 1 / step_radians;
    for (int k = count; k < blocks() * kBlock; ++k) {
        x[k] = x[count - 1];
        y[k] = y[count - 1];
    }
    std::fill_n(nearness, blocks() * kBlock, least_nearness);
    std::fill_n(least, blocks(), least_nearness);
}

ISPACE_SIMD_CLONES
void drawLines(const FlatTree& tree, const FlatView& view, FlatFan& fan) {
    drawTree<false>(tree, view, fan);
}

ISPACE_SIMD_CLONES
void drawLinesAndCosines(const FlatTree& tree, const FlatView& view, FlatFan& fan) {
    std::fill_n(fan.cosine, fan.blocks() * kBlock, 0.0);
    drawTree<true>(tree, view, fan);
}

}  // namespace ispace
