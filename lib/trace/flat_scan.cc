// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "base/simd.h"

namespace ispace {

namespace {

constexpr int kWidth = FlatTree::kWidth;
constexpr int kBlock = FlatScan::kBlock;
constexpr double kTurn = 2 * std::numbers::pi;
/// Beams within this angle of a line's ends are tested, in radians: more than kFlatEdgeAngle and
/// what angleOf() and the directions err.
constexpr double kSlack = 2.5e-5;

/// What of a scan the loops over lanes need.
struct Frame {
    double cos, sin, rate, middle, count;
    explicit Frame(const FlatScan& scan)
        : cos(scan.cos),
          sin(scan.sin),
          rate(scan.rate),
          middle((scan.count - 1) * 0.5),
          count(scan.count) {}
    /// The number of beams before this angle, and a fraction.
    [[nodiscard]] ISPACE_INLINE double beam(double angle) const {
        return flatMin(flatMax(angle * rate + middle + 1, 0.0), count);
    }
};

/// Beams of a scan, first > last if none; an angle behind the middle of the scan cuts the turn, so
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
    double inverse_range;
    std::int32_t child;
    std::int16_t first, last, other_first, other_last;
};

ISPACE_INLINE bool isSeen(const FlatScan& scan, int first, int last, double inverse_range) {
    for (int block = first; block <= last; ++block)
        if (scan.least[block] <= inverse_range) return true;
    return false;
}

ISPACE_INLINE bool isSeen(const FlatScan& scan, const Waiting& box) {
    return isSeen(scan, box.first, box.last, box.inverse_range) ||
           isSeen(scan, box.other_first, box.other_last, box.inverse_range);
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

/// Draws a line into a block; returns the least inverse range of it.
template <bool kCosines>
ISPACE_INLINE double drawBlock(FlatScan& scan, int block, const FlatLine& line) {
    const std::ptrdiff_t begin = std::ptrdiff_t{block} * kBlock;
    const double* const x = scan.x + begin;
    const double* const y = scan.y + begin;
    double* const inverse_range = scan.inverse_range + begin;
    double* const cosine = scan.cosine + begin;
    double least[kBlock];
    ISPACE_LANES for (int i = 0; i < kBlock; ++i) {
        const double here = inverseRangeAlong(line, x[i], y[i]);
        const double old = inverse_range[i];
        if constexpr (kCosines) {
            const double incidence = here * line.height;
            const double tied = flatChoice(here == old, flatMax(incidence, cosine[i]), cosine[i]);
            cosine[i] = flatChoice(here > old, incidence, tied);
        }
        least[i] = flatMax(here, old);
        inverse_range[i] = least[i];
    }
    double four[4];
    for (int i = 0; i < 4; ++i) four[i] = flatMin(least[i], least[i + 4]);
    return flatMin(flatMin(four[0], four[2]), flatMin(four[1], four[3]));
}

template <bool kCosines>
ISPACE_INLINE void drawSpan(FlatScan& scan, int first, int last, const FlatLine& line) {
    for (int block = first / kBlock; block <= last / kBlock; ++block)
        if (scan.least[block] <= line.nearest)
            scan.least[block] = drawBlock<kCosines>(scan, block, line);
}

template <bool kCosines>
ISPACE_INLINE void drawLeaf(const FlatTree& tree, const FlatView& view, const FlatTree::Leaf& leaf,
                            const Frame& frame, FlatScan& scan) {
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
        if (mayContinueTouched(lines.height[i], view.ray_epsilon) &&
            continuesTouched(tree, leaf, i, view.x, view.y, view.ray_epsilon))
            continue;
        const FlatLine line = lines[i];
        if (plain) drawSpan<kCosines>(scan, spans.first[i], spans.last[i], line);
        if (other) drawSpan<kCosines>(scan, spans.other_first[i], spans.other_last[i], line);
    }
}

/// Draws a round body into blocks of beams.
template <bool kCosines>
void drawRound(FlatScan& scan, int first, int last, double nearest, const RoundFrom& round) {
    for (int block = first; block <= last; ++block) {
        if (scan.least[block] > nearest) continue;
        double least = 1e300;
        for (int i = block * kBlock; i < (block + 1) * kBlock; ++i) {
            const RoundFrom::Hit met = round.meet<kCosines>(scan.x[i], scan.y[i]);
            const double old = scan.inverse_range[i];
            if (kCosines && met.inverse_range >= old)
                scan.cosine[i] =
                    met.inverse_range > old ? met.cosine : std::max(met.cosine, scan.cosine[i]);
            scan.inverse_range[i] = std::max(met.inverse_range, old);
            least = std::min(least, scan.inverse_range[i]);
        }
        scan.least[block] = least;
    }
}

struct Stack {
    Waiting entries[FlatTree::kStack];
    int count = 0;
};

/// Puts those children on the stack that may shorten beams, the nearest on top.
ISPACE_INLINE void visit(const FlatTree::Node& node, const FlatView& view, const Frame& frame,
                         const FlatScan& scan, Stack& stack) {
    alignas(64) double inverse_range[kWidth];
    alignas(64) double ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth];
    Spans spans;
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        const double left = node.left[i] - view.x, right = node.right[i] - view.x;
        const double low = node.low[i] - view.y, high = node.high[i] - view.y;
        inverse_range[i] = 1 / distanceOf(left, right, low, high);
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
        next.inverse_range = inverse_range[i];
        next.child = node.child[i];
        const bool around = inverse_range[i] > 1e300;
        const bool plain = spans.first[i] <= spans.last[i];
        const bool other = spans.other_first[i] <= spans.other_last[i];
        if (!around && !plain && !other) continue;
        const auto block = [](int beam) { return static_cast<std::int16_t>(beam / kBlock); };
        next.first = around ? std::int16_t{0} : block(spans.first[i]);
        next.last = around ? block(scan.count - 1)
                           : static_cast<std::int16_t>(plain ? block(spans.last[i]) : -1);
        next.other_first = block(spans.other_first[i]);
        next.other_last = static_cast<std::int16_t>(other ? block(spans.other_last[i]) : -1);
        if (!isSeen(scan, next)) continue;
        int place = stack.count++;
        for (; place > bottom && stack.entries[place - 1].inverse_range > next.inverse_range;
             --place)
            stack.entries[place] = stack.entries[place - 1];
        stack.entries[place] = next;
    }
}

template <bool kCosines>
ISPACE_INLINE void drawTree(const FlatTree& tree, const FlatView& view, FlatScan& scan) {
    if (tree.nodes.empty()) return;
    const Frame frame(scan);
    Stack stack;
    visit(tree.nodes.front(), view, frame, scan, stack);
    while (stack.count > 0) {
        const Waiting box = stack.entries[--stack.count];
        if (!isSeen(scan, box)) continue;
        if (box.child >= 0)
            visit(tree.node(box.child), view, frame, scan, stack);
        else
            drawLeaf<kCosines>(tree, view, tree.leaf(box.child), frame, scan);
    }
    if (tree.round_root < 0) return;
    visit(tree.node(tree.round_root), view, frame, scan, stack);
    while (stack.count > 0) {
        const Waiting box = stack.entries[--stack.count];
        if (!isSeen(scan, box)) continue;
        if (box.child >= 0) {
            visit(tree.node(box.child), view, frame, scan, stack);
            continue;
        }
        const RoundFrom round(tree.round(box.child), view.x, view.y, view.ray_epsilon);
        drawRound<kCosines>(scan, box.first, box.last, box.inverse_range, round);
        drawRound<kCosines>(scan, box.other_first, box.other_last, box.inverse_range, round);
    }
}

}  // namespace

void FlatScan::begin(double step_radians, double min_inverse_range) {
    const int i = (count - 1) / 2, j = count / 2;
    cos = x[i] + x[j];
    sin = y[i] + y[j];
    rate = 1 / step_radians;
    for (int k = count; k < blocks() * kBlock; ++k) {
        x[k] = x[count - 1];
        y[k] = y[count - 1];
    }
    std::fill_n(inverse_range, blocks() * kBlock, min_inverse_range);
    std::fill_n(least, blocks(), min_inverse_range);
}

ISPACE_SIMD_CLONES
void drawLines(const FlatTree& tree, const FlatView& view, FlatScan& scan) {
    drawTree<false>(tree, view, scan);
}

ISPACE_SIMD_CLONES
void drawLinesAndCosines(const FlatTree& tree, const FlatView& view, FlatScan& scan) {
    std::fill_n(scan.cosine, scan.blocks() * kBlock, 0.0);
    drawTree<true>(tree, view, scan);
}

}  // namespace ispace
