// SPDX-License-Identifier: GPL-3.0-or-later
// Scans as pictures with one row: lines are drawn into blocks of eight beams, each with the
// farthest range in it, so that boxes and lines behind that are skipped, as by a hierarchical
// z-buffer (N. Greene, M. Kass, G. Miller, Hierarchical Z-buffer visibility, 1993). Angles in
// float32 with kSlack choose the blocks; each beam is decided in doubles by flat_kernels.h, as
// single rays are.
#include "trace/flat_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "base/simd.h"

namespace ispace {

namespace {

constexpr int kWidth = FlatTree::kWidth;
constexpr int kBlock = FlatScan::kBlock, kBlockBits = 3;
static_assert(kBlock == 1 << kBlockBits);
constexpr float kPi = std::numbers::pi_v<float>;
/// Beams within this angle of a line's ends are tested, in radians: more than kFlatEdgeAngle plus
/// the errors of angleOf() and of the directions.
constexpr float kSlack = 2.5e-5F;
/// More than the float32 rounding of distances.
constexpr float kRounding = 1 + 2e-6F;

/// Values of a scan for the loops over lanes.
struct Frame {
    float cos, sin, rate, middle, count;
    std::int32_t margin;  ///< beams by which spans may be too wide, at each end
    explicit Frame(const FlatScan& scan)
        : cos(scan.cos),
          sin(scan.sin),
          rate(scan.rate),
          middle(static_cast<float>(scan.count + 1) * 0.5F),
          count(static_cast<float>(scan.count)),
          margin(static_cast<std::int32_t>(flatMin(2 * kSlack * rate, count)) + 2) {}
    /// Returns the angle of a direction from the middle of the scan.
    [[nodiscard]] ISPACE_INLINE float angle(float x, float y) const {
        return angleOf(x * cos + y * sin, y * cos - x * sin);
    }
    /// Returns the fractional number of beams before this angle.
    [[nodiscard]] ISPACE_INLINE float beam(float angle) const {
        return flatMin(flatMax(angle * rate + middle, 0.0F), count);
    }
};

/// Directions a and b less than half a turn apart, counter-clockwise, of any length.
struct alignas(64) Corners {
    float ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth];
};

/// Range of blocks, first > last if empty. The turn is cut at an angle behind the middle of the
/// scan, so that a span may have a second range at the other end.
struct alignas(64) Spans {
    std::int32_t first[kWidth], last[kWidth], other_first[kWidth], other_last[kWidth];
    /// Blocks of the first range with all beams well between a and b.
    std::int32_t inner_first[kWidth], inner_last[kWidth];

    ISPACE_INLINE void set(const Frame& frame, const Corners& corners) {
        const std::int32_t margin = frame.margin;
        alignas(32) float begin[kWidth], stop[kWidth], shift[kWidth];
        ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
            const float from = frame.angle(corners.ax[i], corners.ay[i]);
            const float end = frame.angle(corners.bx[i], corners.by[i]);
            // At least half a turn, else it is rounding.
            const float whole = end < from - 1 ? 2 * kPi : 0.0F;
            begin[i] = from - kSlack;
            stop[i] = end + whole + kSlack;
            const float back = begin[i] < -kPi ? 2 * kPi : 1e9F;
            shift[i] = stop[i] > kPi ? -2 * kPi : back;
        }
        ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
            const auto low = static_cast<std::int32_t>(frame.beam(begin[i]));
            const auto high = static_cast<std::int32_t>(frame.beam(stop[i]));
            first[i] = low >> kBlockBits;
            last[i] = low < high ? (high - 1) >> kBlockBits : -1;
            inner_first[i] = (low + margin + kBlock - 1) >> kBlockBits;
            // An edge-on line across the cut may seem to span a full turn.
            inner_last[i] =
                stop[i] - begin[i] < kPi + 0.1F ? ((high - margin) >> kBlockBits) - 1 : -1;
        }
        ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
            const auto low = static_cast<std::int32_t>(frame.beam(begin[i] + shift[i]));
            const auto high = static_cast<std::int32_t>(frame.beam(stop[i] + shift[i]));
            other_first[i] = low >> kBlockBits;
            other_last[i] = low < high ? (high - 1) >> kBlockBits : -1;
        }
    }
};

/// A node or leaf to visit, and the blocks of beams that it may shorten.
struct Waiting {
    float inverse_range;
    std::int32_t child;
    std::int32_t first, last, other_first, other_last;
};

ISPACE_INLINE bool isSeen(const FlatScan& scan, int first, int last, float inverse_range) {
    for (int block = first; block <= last; ++block)
        if (scan.least[block] <= inverse_range) return true;
    return false;
}

ISPACE_INLINE bool isSeen(const FlatScan& scan, const Waiting& box) {
    return isSeen(scan, box.first, box.last, box.inverse_range) ||
           isSeen(scan, box.other_first, box.other_last, box.inverse_range);
}

/// Lines of a leaf, one array per component.
struct alignas(64) Lines {
    double ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth], ux[kWidth], uy[kWidth];
    double nearest[kWidth], height[kWidth], edge[kWidth];
    float most[kWidth];  ///< upper bound of the nearest, in float32

    ISPACE_INLINE FlatLine operator[](int i) const {
        return {ax[i], ay[i], bx[i], by[i], ux[i], uy[i], nearest[i], height[i], edge[i], true};
    }
};

ISPACE_INLINE float leastOf(const double* eight) {
    double four[4], two[2];
    ISPACE_LANES for (int i = 0; i < 4; ++i) four[i] = flatMin(eight[i], eight[i + 4]);
    ISPACE_LANES for (int i = 0; i < 2; ++i) two[i] = flatMin(four[i], four[i + 2]);
    return static_cast<float>(flatMin(two[0], two[1]));
}

/// Draws a line into a block. `kInner`: all its beams pass well between the ends of the line.
template <bool kCosines, bool kInner>
ISPACE_INLINE void drawBlock(FlatScan& scan, int block, const FlatLine& line) {
    const std::ptrdiff_t begin = std::ptrdiff_t{block} * kBlock;
    const double* const __restrict x = scan.blockOfX(block);
    const double* const __restrict y = scan.blockOfY(block);
    double* const __restrict inverse_range = scan.inverse_range + begin;
    [[maybe_unused]] double* const __restrict cosine = kCosines ? scan.cosine + begin : nullptr;
    double met[kBlock], least[kBlock];
    ISPACE_LANES for (int i = 0; i < kBlock; ++i) {
        const double here =
            kInner ? inverseRangeBetween(line, x[i], y[i]) : inverseRangeAlong(line, x[i], y[i]);
        const double old = inverse_range[i];
        if constexpr (kCosines) {
            const double incidence = here * line.height;
            const double tied = simd::choose(here == old, flatMax(incidence, cosine[i]), cosine[i]);
            cosine[i] = simd::choose(here > old, incidence, tied);
        }
        met[i] = here;
        least[i] = flatMax(here, old);
        inverse_range[i] = least[i];
    }
    // Between two beams the distance of a line does not exceed that at both.
    const auto ends = static_cast<float>(flatMin(met[0], met[kBlock - 1]));
    scan.least[block] = kInner ? flatMax(ends, scan.least[block]) : leastOf(least);
}

/// Draws a line into the given blocks that it may shorten.
template <bool kCosines, bool kInner>
ISPACE_INLINE void drawBlocks(FlatScan& scan, int first, int last, float most,
                              const FlatLine& line) {
    for (int block = first; block <= last; ++block)
        if (scan.least[block] <= most) drawBlock<kCosines, kInner>(scan, block, line);
}

/// Draws line i of a leaf.
template <bool kCosines>
ISPACE_INLINE void drawLine(FlatScan& scan, const Spans& spans, int i, float most,
                            const FlatLine& line) {
    const int first = spans.first[i], last = spans.last[i];
    const int inner_first = spans.inner_first[i], inner_last = spans.inner_last[i];
    if (inner_first > inner_last) {
        drawBlocks<kCosines, false>(scan, first, last, most, line);
    } else {
        drawBlocks<kCosines, false>(scan, first, inner_first - 1, most, line);
        drawBlocks<kCosines, true>(scan, inner_first, inner_last, most, line);
        drawBlocks<kCosines, false>(scan, inner_last + 1, last, most, line);
    }
    drawBlocks<kCosines, false>(scan, spans.other_first[i], spans.other_last[i], most, line);
}

template <bool kCosines>
ISPACE_INLINE void drawLeaf(const FlatTree& tree, const FlatView& view, const FlatTree::Leaf& leaf,
                            const Frame& frame, FlatScan& scan) {
    Lines lines;
    Corners corners;
    Spans spans;
    // Below this distance a line may be edge-on and ignored.
    const double thin = flatMax(2 * kFlatEdge, 1.001 * view.ray_epsilon);
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
    }
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        corners.ax[i] = static_cast<float>(lines.ax[i]);
        corners.ay[i] = static_cast<float>(lines.ay[i]);
        corners.bx[i] = static_cast<float>(lines.bx[i]);
        corners.by[i] = static_cast<float>(lines.by[i]);
        lines.most[i] = static_cast<float>(lines.nearest[i]) * kRounding;
    }
    spans.set(frame, corners);
    for (int i = 0, end = leaf.count(); i < end; ++i) {
        const bool plain = spans.first[i] <= spans.last[i];
        const bool other = spans.other_first[i] <= spans.other_last[i];
        if (!plain && !other) continue;
        if (!(lines.height[i] > thin)) {
            if (!lineFrom(leaf, i, view.x, view.y).stops) continue;
            if (mayContinueTouched(lines.height[i], view.ray_epsilon) &&
                continuesTouched(tree, leaf, i, view.x, view.y, view.ray_epsilon))
                continue;
        }
        drawLine<kCosines>(scan, spans, i, lines.most[i], lines[i]);
    }
}

/// Draws a round body into blocks of beams.
template <bool kCosines>
void drawRound(FlatScan& scan, int first, int last, float most, const RoundFrom& round) {
    for (int block = first; block <= last; ++block) {
        if (scan.least[block] > most) continue;
        const double* const x = scan.blockOfX(block);
        const double* const y = scan.blockOfY(block);
        const std::ptrdiff_t begin = std::ptrdiff_t{block} * kBlock;
        for (int i = 0; i < kBlock; ++i) {
            const RoundFrom::Hit met = round.meet<kCosines>(x[i], y[i]);
            double& inverse_range = scan.inverse_range[begin + i];
            if (kCosines && met.inverse_range >= inverse_range) {
                double& cosine = scan.cosine[begin + i];
                cosine =
                    met.inverse_range > inverse_range ? met.cosine : std::max(met.cosine, cosine);
            }
            inverse_range = std::max(met.inverse_range, inverse_range);
        }
        scan.least[block] = leastOf(scan.inverse_range + begin);
    }
}

struct Stack {
    Waiting entries[FlatTree::kStack + kWidth];
    int count = 0;
};

/// Pushes the children that may shorten beams, the nearest on top.
ISPACE_INLINE void visit(const FlatTree::Node& node, const FlatView& view, const Frame& frame,
                         const FlatScan& scan, Stack& stack) {
    alignas(64) float inverse_range[kWidth];
    Corners corners;
    Spans spans;
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        const auto left = static_cast<float>(node.left[i] - view.x);
        const auto right = static_cast<float>(node.right[i] - view.x);
        const auto low = static_cast<float>(node.low[i] - view.y);
        const auto high = static_cast<float>(node.high[i] - view.y);
        inverse_range[i] = kRounding / distanceOf(left, right, low, high);
        // The corners that bound the box as seen from the origin.
        const bool above = low > 0, below = high<0, east = left> 0, west = right < 0;
        corners.ax[i] = above ? right : (below ? left : (east ? left : right));
        corners.bx[i] = above ? left : (below ? right : (east ? left : right));
        corners.ay[i] = east ? low : (west ? high : (above ? low : high));
        corners.by[i] = east ? high : (west ? low : (above ? low : high));
    }
    spans.set(frame, corners);
    // Sorts without branches, which would be unpredictable: by approximate distance, boxes without
    // beams last. Keys of one node differ.
    alignas(32) std::int32_t key[kWidth], rank[kWidth], last[kWidth];
    const int blocks = scan.blocks();
    int count = 0;
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        const bool around = inverse_range[i] > 1e6F;
        spans.first[i] = around ? 0 : spans.first[i];
        spans.last[i] = around ? blocks - 1 : spans.last[i];
        last[i] = i < node.count ? flatMax(spans.last[i], spans.other_last[i]) : -1;
        key[i] = last[i] >= 0 ? (std::bit_cast<std::int32_t>(inverse_range[i]) & ~7) | i
                              : 0x7ffffff8 | i;
        rank[i] = 0;
    }
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) count += last[i] >= 0 ? 1 : 0;
    for (int k = 0; k < kWidth; ++k) {
        const std::int32_t other = key[k];
        ISPACE_LANES for (int i = 0; i < kWidth; ++i) rank[i] += other < key[i] ? 1 : 0;
    }
    for (int i = 0; i < kWidth; ++i)
        stack.entries[stack.count + rank[i]] = {inverse_range[i],     node.child[i],
                                                spans.first[i],       spans.last[i],
                                                spans.other_first[i], spans.other_last[i]};
    stack.count += count;
}

template <bool kCosines>
ISPACE_INLINE void drawTree(const FlatTree& tree, const FlatView& view, FlatScan& scan) {
    if (tree.nodes.empty()) return;
    const Frame frame(scan);
    Stack stack;
    visit(tree.nodes.front(), view, frame, scan, stack);
    while (stack.count > 0) {
        const Waiting& box = stack.entries[--stack.count];
        if (!isSeen(scan, box)) continue;
        const std::int32_t child = box.child;
        if (child >= 0)
            visit(tree.node(child), view, frame, scan, stack);
        else
            drawLeaf<kCosines>(tree, view, tree.leaf(child), frame, scan);
    }
    if (tree.round_root < 0) return;
    visit(tree.node(tree.round_root), view, frame, scan, stack);
    while (stack.count > 0) {
        const Waiting& box = stack.entries[--stack.count];
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

template <bool kCosines>
ISPACE_INLINE void drawScan(const FlatTree& tree, const FlatView& view, const FlatLimit& limit,
                            const FlatBeams& beams) {
    const auto count = static_cast<std::size_t>(beams.count);
    FlatScan scan;
    alignas(64) double cosine[kCosines ? FlatScan::kMax : 1];
    scan.x = beams.x;
    scan.y = beams.y;
    scan.cosine = cosine;
    scan.count = beams.count;
    const int i = (scan.count - 1) / 2, j = scan.count / 2;
    scan.cos = static_cast<float>(beams.x[i] + beams.x[j]);
    scan.sin = static_cast<float>(beams.y[i] + beams.y[j]);
    scan.rate = static_cast<float>(1 / beams.step);
    for (int k = 0; k < kBlock; ++k) {
        const int beam = std::min((scan.blocks() - 1) * kBlock + k, scan.count - 1);
        scan.last_x[k] = beams.x[beam];
        scan.last_y[k] = beams.y[beam];
    }
    std::fill_n(scan.inverse_range, scan.blocks() * kBlock, limit.inverse_range);
    std::fill_n(scan.least, scan.blocks(), static_cast<float>(limit.inverse_range));
    if constexpr (kCosines) std::fill_n(scan.cosine, scan.blocks() * kBlock, 0.0);
    drawTree<kCosines>(tree, view, scan);
    float* const ranges = beams.ranges;
    for (std::size_t k = 0; k < count; ++k) ranges[k] = limit.rangeOf(scan.inverse_range[k]);
    if constexpr (kCosines)
        for (std::size_t k = 0; k < count; ++k)
            beams.cosines[k] = limit.cosineOf(ranges[k], scan.cosine[k]);
}

ISPACE_SIMD_CLONES
void castRanges(const FlatTree& tree, const FlatView& view, const FlatLimit& limit,
                const FlatBeams& beams) {
    drawScan<false>(tree, view, limit, beams);
}

ISPACE_SIMD_CLONES
void castCosines(const FlatTree& tree, const FlatView& view, const FlatLimit& limit,
                 const FlatBeams& beams) {
    drawScan<true>(tree, view, limit, beams);
}

}  // namespace

void castScan(const FlatTree& tree, const FlatView& view, const FlatLimit& limit,
              const FlatBeams& beams) {
    beams.cosines == nullptr ? castRanges(tree, view, limit, beams)
                             : castCosines(tree, view, limit, beams);
}

}  // namespace ispace
