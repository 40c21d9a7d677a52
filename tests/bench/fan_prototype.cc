// SPDX-License-Identifier: GPL-3.0-or-later
#include "fan_prototype.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/simd.h"
#include "trace/flat_world.h"

namespace ispace::bench {

namespace {

constexpr int kBlock = FanPrototype::Fan::kBlock;
constexpr float kPi = std::numbers::pi_v<float>;

#define LANES _Pragma("GCC unroll 1")

ISPACE_INLINE float least(float a, float b) { return a < b ? a : b; }
ISPACE_INLINE float most(float a, float b) { return a > b ? a : b; }

/// Within 1e-5.
ISPACE_INLINE float angleOf(float x, float y) {
    const float far = std::fabs(x), wide = std::fabs(y);
    const float ratio = least(far, wide) / most(most(far, wide), 1e-30F);
    const float square = ratio * ratio;
    const float octant =
        ratio * (0.9998660F +
                 square * (-0.3302995F +
                           square * (0.1801410F + square * (-0.0851330F + square * 0.0208351F))));
    const bool is_steep = wide > far, is_behind = x < 0;
    const float quarter = (is_steep ? kPi / 2 : 0.0F) + (is_steep ? -1.0F : 1.0F) * octant;
    const float half = (is_behind ? kPi : 0.0F) + (is_behind ? -1.0F : 1.0F) * quarter;
    return std::copysign(half, y);
}

}  // namespace

FanPrototype::FanPrototype(std::span<const Segment2> lines) {
    const FlatTree tree(lines);
    for (const FlatTree::Node& node : tree.nodes) {
        Node& made = nodes_.emplace_back();
        made.count = node.count;
        for (std::size_t i = 0; i < kWidth; ++i) {
            made.left[i] = static_cast<float>(node.left[i]);
            made.right[i] = static_cast<float>(node.right[i]);
            made.low[i] = static_cast<float>(node.low[i]);
            made.high[i] = static_cast<float>(node.high[i]);
            made.child[i] = node.child[i];
        }
    }
    for (const FlatTree::Leaf& leaf : tree.leaves) {
        Leaf& made = leaves_.emplace_back();
        made.count = leaf.count();
        for (std::size_t i = 0; i < kWidth; ++i) {
            made.ax[i] = static_cast<float>(leaf.ax[i]);
            made.ay[i] = static_cast<float>(leaf.ay[i]);
            made.bx[i] = static_cast<float>(leaf.bx[i]);
            made.by[i] = static_cast<float>(leaf.by[i]);
        }
    }
}

FanPrototype::Fan::Fan(const Directions& directions) : count(static_cast<int>(directions.size())) {
    const std::size_t blocks = (directions.size() + kBlock - 1) / kBlock;
    for (std::size_t k = 0; k < blocks * kBlock; ++k) {
        const std::size_t i = std::min(k, directions.size() - 1);
        x.push_back(static_cast<float>(directions.x[i]));
        y.push_back(static_cast<float>(directions.y[i]));
    }
    const auto [first, step] = *directions.arc;
    const double middle = first.radians() + 0.5 * (count - 1) * step.radians();
    cos = static_cast<float>(std::cos(middle));
    sin = static_cast<float>(std::sin(middle));
    rate = static_cast<float>(1 / step.radians());
}

/// One fan on its way through the hierarchy.
struct FanPrototype::Walk {
    struct Waiting {
        float distance;
        std::int32_t child;
        std::int32_t first, last, other_first, other_last;  // beams
    };
    /// Beams between two directions, counter-clockwise, and those at the other end of the turn.
    struct alignas(32) Spans {
        std::int32_t first[kWidth], last[kWidth], other_first[kWidth], other_last[kWidth];
    };

    const FanPrototype& world;
    const Fan& fan;
    float ox, oy;
    float* ranges;
    float farthest[2048 / kBlock];  // of each block
    Waiting stack[FlatTree::kStack];
    int waiting = 0;

    ISPACE_INLINE void setSpans(const float* ax, const float* ay, const float* bx, const float* by,
                                Spans& spans) const {
        const float middle = 0.5F * static_cast<float>(fan.count - 1);
        const auto count = static_cast<float>(fan.count);
        const float c = fan.cos, s = fan.sin, rate = fan.rate;
        LANES for (int i = 0; i < kWidth; ++i) {
            const float begin = angleOf(ax[i] * c + ay[i] * s, ay[i] * c - ax[i] * s);
            const float end = angleOf(bx[i] * c + by[i] * s, by[i] * c - bx[i] * s);
            const float stop = end < begin - 1 ? end + 2 * kPi : end;
            const float low = begin * rate + middle + 1, high = stop * rate + middle + 1;
            const float shift = stop > kPi ? 2 * kPi * rate : 1e9F;
            spans.first[i] = static_cast<std::int32_t>(least(most(low, 0), count));
            spans.last[i] = static_cast<std::int32_t>(least(most(high, 0), count)) - 1;
            spans.other_first[i] = static_cast<std::int32_t>(least(most(low - shift, 0), count));
            spans.other_last[i] =
                static_cast<std::int32_t>(least(most(high - shift, 0), count)) - 1;
        }
    }

    [[nodiscard]] ISPACE_INLINE bool isSeen(int first, int last, float distance) const {
        if (first > last) return false;
        for (int block = first / kBlock; block <= last / kBlock; ++block)
            if (farthest[block] > distance) return true;
        return false;
    }
    [[nodiscard]] ISPACE_INLINE bool isSeen(const Waiting& box) const {
        return isSeen(box.first, box.last, box.distance) ||
               isSeen(box.other_first, box.other_last, box.distance);
    }

    ISPACE_INLINE void visit(const Node& node) {
        alignas(32) float ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth], distance[kWidth];
        LANES for (int i = 0; i < kWidth; ++i) {
            const float left = node.left[i] - ox, right = node.right[i] - ox;
            const float low = node.low[i] - oy, high = node.high[i] - oy;
            const float x = most(most(left, -right), 0), y = most(most(low, -high), 0);
            distance[i] = std::sqrt(x * x + y * y);
            const bool above = low > 0, below = high<0, east = left> 0, west = right < 0;
            ax[i] = above ? right : (below ? left : (east ? left : right));
            bx[i] = above ? left : (below ? right : (east ? left : right));
            ay[i] = east ? low : (west ? high : (above ? low : high));
            by[i] = east ? high : (west ? low : (above ? low : high));
        }
        Spans spans;
        setSpans(ax, ay, bx, by, spans);
        const int bottom = waiting;
        for (int i = 0; i < node.count; ++i) {
            Waiting next{distance[i],   node.child[i],        spans.first[i],
                         spans.last[i], spans.other_first[i], spans.other_last[i]};
            if (distance[i] == 0) {
                next.first = 0;
                next.last = fan.count - 1;
            }
            if (!isSeen(next)) continue;
            int place = waiting++;
            for (; place > bottom && stack[place - 1].distance < next.distance; --place)
                stack[place] = stack[place - 1];
            stack[place] = next;
        }
    }

    ISPACE_INLINE void draw(int first, int last, float ax, float ay, float ex, float ey, float near,
                            float far) {
        const float area = ax * ey - ay * ex;
        for (int block = first / kBlock; block <= last / kBlock; ++block) {
            if (farthest[block] <= near) continue;
            const int begin = block * kBlock;
            const float* const x = fan.x.data() + begin;
            const float* const y = fan.y.data() + begin;
            float* const range = ranges + begin;
            float here[kBlock];
            LANES for (int k = 0; k < kBlock; ++k) {
                const float t = area / (x[k] * ey - y[k] * ex);
                const float met = least(most(t, near), far);
                const bool is_between = (begin + k >= first) & (begin + k <= last);
                here[k] = simd::choose(is_between & (met < range[k]), met, range[k]);
                range[k] = here[k];
            }
            float eight[8];
            for (int k = 0; k < 8; ++k) eight[k] = most(here[k], here[k + 8]);
            for (int k = 0; k < 4; ++k) eight[k] = most(eight[k], eight[k + 4]);
            farthest[block] = most(most(eight[0], eight[1]), most(eight[2], eight[3]));
        }
    }

    ISPACE_INLINE void drawLeaf(const Leaf& leaf) {
        alignas(32) float ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth];
        alignas(32) float near[kWidth], far[kWidth];
        LANES for (int i = 0; i < kWidth; ++i) {
            const float px = leaf.ax[i] - ox, py = leaf.ay[i] - oy;
            const float qx = leaf.bx[i] - ox, qy = leaf.by[i] - oy;
            const bool turned = px * qy - py * qx < 0;
            ax[i] = turned ? qx : px;
            ay[i] = turned ? qy : py;
            bx[i] = turned ? px : qx;
            by[i] = turned ? py : qy;
            const float ex = qx - px, ey = qy - py;
            const float along =
                least(most(-(px * ex + py * ey) / (ex * ex + ey * ey + 1e-30F), 0), 1);
            const float nx = px + along * ex, ny = py + along * ey;
            near[i] = std::sqrt(nx * nx + ny * ny);
            far[i] = std::sqrt(most(px * px + py * py, qx * qx + qy * qy));
        }
        Spans spans;
        setSpans(ax, ay, bx, by, spans);
        for (int i = 0; i < leaf.count; ++i) {
            const float ex = bx[i] - ax[i], ey = by[i] - ay[i];
            if (spans.first[i] <= spans.last[i])
                draw(spans.first[i], spans.last[i], ax[i], ay[i], ex, ey, near[i], far[i]);
            if (spans.other_first[i] <= spans.other_last[i])
                draw(spans.other_first[i], spans.other_last[i], ax[i], ay[i], ex, ey, near[i],
                     far[i]);
        }
    }

    ISPACE_INLINE void run(float max_range) {
        const int blocks = (fan.count + kBlock - 1) / kBlock;
        std::fill_n(ranges, blocks * kBlock, max_range);
        for (int k = fan.count; k < blocks * kBlock; ++k) ranges[k] = 0;  // no beams
        std::fill_n(farthest, blocks, max_range);
        if (world.nodes_.empty()) return;
        visit(world.nodes_.front());
        while (waiting > 0) {
            const Waiting box = stack[--waiting];
            if (!isSeen(box)) continue;
            if (box.child >= 0)
                visit(world.nodes_[static_cast<std::uint32_t>(box.child)]);
            else
                drawLeaf(world.leaves_[~static_cast<std::uint32_t>(box.child)]);
        }
        LANES for (int k = 0; k < blocks * kBlock; ++k) {
            if (ranges[k] >= max_range) ranges[k] = kNoReturn;
        }
    }
};

ISPACE_SIMD_CLONES
void FanPrototype::cast(Point2 origin, const Fan& fan, float max_range,
                        std::span<float> ranges) const {
    Walk walk{
        *this, fan, static_cast<float>(origin.x), static_cast<float>(origin.y), ranges.data(), {},
        {},    0};
    walk.run(max_range);
}

}  // namespace ispace::bench
