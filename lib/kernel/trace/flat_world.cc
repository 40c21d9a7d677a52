// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses among three ways to the same bits: beams at even steps are drawn as a scan
// (flat_scan.cc), rays of similar directions are traced in packets whose size adapts to how near
// they lie (flat_packet.cc), and others alone, by the traversal here. A ray passes a box if corners
// lie on both of its sides within slackOf(), more than rounding; so boxes are never missed.
#include "trace/flat_world.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/simd.h"
#include "geom/point.h"
#include "trace/flat_kernels.h"
#include "trace/rays.h"

namespace ispace {

namespace {

constexpr int kNodeWidth = FlatTree::kWidth;

struct UnitVector {
    double x, y;
};

/// More than kFlatEdge plus the rounding of cross products with unit vectors.
ISPACE_INLINE double slackOf(double x, double y) {
    return 2 * kFlatEdge + 1e-12 * (std::fabs(x) + std::fabs(y));
}

/// Pushes the children that the ray may meet, the nearest on top.
ISPACE_INLINE void visit(const FlatTree::Node& node, const FlatView& view, const UnitVector& ray,
                         const FlatHit& hit, FlatStack& stack) {
    alignas(64) double distance[kNodeWidth];
    ISPACE_LANES for (int i = 0; i < kNodeWidth; ++i) {
        const double left = node.left[i] - view.x, right = node.right[i] - view.x;
        const double low = node.low[i] - view.y, high = node.high[i] - view.y;
        // The ray passes the box if corners lie on both of its sides, and one is ahead.
        const double p = ray.x * low, q = ray.x * high, r = ray.y * left, s = ray.y * right;
        const double right_side = flatMin(p, q) - flatMax(r, s);
        const double left_side = flatMax(p, q) - flatMin(r, s);
        const double ahead =
            flatMax(ray.x * left, ray.x * right) + flatMax(ray.y * low, ray.y * high);
        const double slack = slackOf(flatMax(std::fabs(left), std::fabs(right)),
                                     flatMax(std::fabs(low), std::fabs(high)));
        const double near = distanceOf(left, right, low, high);
        const bool meets = (right_side <= slack) & (left_side >= -slack) & (ahead >= -slack) &
                           mayBeNearer(near, hit.inverse_range);
        distance[i] = simd::choose(meets, near, -1.0);
    }
    stack.push(node, distance);
}

ISPACE_INLINE void meetLeaf(const FlatTree& tree, const FlatView& view, const FlatTree::Leaf& leaf,
                            const UnitVector& ray, FlatHit& hit) {
    alignas(64) double meets[kNodeWidth];
    ISPACE_LANES for (int i = 0; i < kNodeWidth; ++i) {
        const double px = leaf.ax[i] - view.x, py = leaf.ay[i] - view.y;
        const double qx = leaf.bx[i] - view.x, qy = leaf.by[i] - view.y;
        const double p = ray.x * py - ray.y * px, q = ray.x * qy - ray.y * qx;
        const double most =
            slackOf(flatMax(std::fabs(px), std::fabs(qx)), flatMax(std::fabs(py), std::fabs(qy)));
        const double ahead = flatMax(ray.x * px + ray.y * py, ray.x * qx + ray.y * qy);
        const double near =
            distanceOf(flatMin(px, qx), flatMax(px, qx), flatMin(py, qy), flatMax(py, qy));
        const double least = flatMin(p, q), greatest = flatMax(p, q);
        // Ends lie on both sides of the ray's line, and not both behind.
        const bool is_met = (least <= most) & (greatest >= -most) & (ahead >= -most) &
                            mayBeNearer(near, hit.inverse_range);
        meets[i] = is_met ? 1.0 : 0.0;
    }
    for (int i = 0, end = leaf.count(); i < end; ++i) {
        if (meets[i] == 0) continue;
        const FlatLine line = lineFrom(leaf, i, view.x, view.y);
        const double inverse_range = inverseRangeAlong(line, ray.x, ray.y);
        if (!line.stops || inverse_range < hit.inverse_range || inverse_range <= 0) continue;
        const double cosine = inverse_range * line.height;
        if (inverse_range == hit.inverse_range && cosine <= hit.cosine) continue;
        if (mayContinueTouched(line.height, view.ray_epsilon) &&
            continuesTouched(tree, leaf, i, view.x, view.y, view.ray_epsilon))
            continue;
        hit = {inverse_range, cosine};
    }
}

ISPACE_INLINE void meetRound(const FlatTree::Round& round, const FlatView& view,
                             const UnitVector& ray, FlatHit& hit) {
    const RoundFrom::Hit met =
        RoundFrom(round, view.x, view.y, view.ray_epsilon).meet<true>(ray.x, ray.y);
    if (met.inverse_range <= 0 || met.inverse_range < hit.inverse_range) return;
    if (met.inverse_range == hit.inverse_range && met.cosine <= hit.cosine) return;
    hit = {met.inverse_range, met.cosine};
}

}  // namespace

ISPACE_SIMD_CLONES
FlatHit firstLine(const FlatTree& tree, const FlatView& view, double x, double y,
                  double min_inverse_range) {
    FlatHit hit{min_inverse_range};
    if (tree.nodes.empty()) return hit;
    const UnitVector ray{x, y};
    FlatStack stack;
    visit(tree.nodes.front(), view, ray, hit, stack);
    while (!stack.empty()) {
        const FlatStack::Entry box = stack.pop();
        if (!mayBeNearer(box.distance, hit.inverse_range)) continue;
        if (box.child >= 0)
            visit(tree.node(box.child), view, ray, hit, stack);
        else
            meetLeaf(tree, view, tree.leaf(box.child), ray, hit);
    }
    if (tree.round_root < 0) return hit;
    visit(tree.node(tree.round_root), view, ray, hit, stack);
    while (!stack.empty()) {
        const FlatStack::Entry box = stack.pop();
        if (!mayBeNearer(box.distance, hit.inverse_range)) continue;
        if (box.child >= 0)
            visit(tree.node(box.child), view, ray, hit, stack);
        else
            meetRound(tree.round(box.child), view, ray, hit);
    }
    return hit;
}

namespace {

/// Rays and their output arrays.
struct Cast {
    const Point2* origins;
    bool is_one_origin;
    const Directions& directions;
    double ray_epsilon;
    FlatLimit limit;
    float* ranges;
    float* cosines;  ///< or null

    [[nodiscard]] Point2 origin(std::size_t i) const { return origins[is_one_origin ? 0 : i]; }
};

bool isScan(const Directions& directions) {
    if (!directions.arc || directions.size() < FlatScan::kMin) return false;
    const double step = std::fabs(directions.arc->step.radians());
    return step >= FlatScan::kMinStep && step <= FlatScan::kMaxStep;
}

bool isForScan(double coordinate) { return std::fabs(coordinate) <= FlatScan::kMaxCoordinate; }

bool isForScan(const FlatTree::Node& node) {
    for (int i = 0; i < node.count; ++i)
        for (const double at : {node.left[i], node.right[i], node.low[i], node.high[i]})
            if (!isForScan(at)) return false;
    return true;
}

/// True if all rays are.
bool isForScan(const FlatTree& tree) {
    return (tree.nodes.empty() || isForScan(tree.nodes.front())) &&
           (tree.round_root < 0 || isForScan(tree.node(tree.round_root)));
}

}  // namespace

struct FlatWorld::Data {
    FlatTree tree;

    double widest_packet;
    bool is_for_scan;

    explicit Data(FlatTree made)
        : tree(std::move(made)), widest_packet(widestPacket(tree)), is_for_scan(isForScan(tree)) {}

    void castRay(const Cast& cast, std::size_t i) const {
        const Point2 origin = cast.origin(i);
        const FlatHit hit =
            firstLine(tree, {origin.x, origin.y, cast.ray_epsilon}, cast.directions.x[i],
                      cast.directions.y[i], cast.limit.inverse_range);
        cast.ranges[i] = cast.limit.rangeOf(hit.inverse_range);
        if (cast.cosines != nullptr)
            cast.cosines[i] = cast.limit.cosineOf(cast.ranges[i], hit.cosine);
    }

    /// Casts rays begin .. begin + count - 1. \returns false, without changes, if single rays are
    /// faster
    [[nodiscard]] bool castPacket(const Cast& cast, std::size_t begin, std::size_t count) const {
        if (count < FlatPacket::kMin) return false;
        constexpr std::size_t kBlock = FlatPacket::kBlock;
        const std::size_t lanes = (count + kBlock - 1) / kBlock * kBlock;
        FlatPacket packet;
        packet.count = static_cast<int>(lanes);
        const auto set = [&](std::size_t lane, std::size_t i) {
            packet.x[lane] = cast.directions.x[i];
            packet.y[lane] = cast.directions.y[i];
            const Point2 origin = cast.origin(i);
            packet.origin_x[lane] = origin.x;
            packet.origin_y[lane] = origin.y;
        };
        for (std::size_t i = 0; i < count; ++i) set(i, begin + i);
        for (std::size_t i = count; i < lanes; ++i) set(i, begin + count / 2);
        const FlatPacketLimits limits{cast.ray_epsilon, cast.limit.inverse_range, widest_packet};
        if (!(cast.cosines == nullptr ? drawLines(tree, limits, packet)
                                      : drawLinesAndCosines(tree, limits, packet)))
            return false;
        float* const ranges = cast.ranges + begin;
        for (std::size_t i = 0; i < count; ++i)
            ranges[i] = cast.limit.rangeOf(packet.inverse_range[i]);
        if (cast.cosines != nullptr)
            for (std::size_t i = 0; i < count; ++i)
                cast.cosines[begin + i] = cast.limit.cosineOf(ranges[i], packet.cosine[i]);
        return true;
    }

    /// Casts in packets as large as the distance between rays permits.
    void castRays(const Cast& cast) const {
        const std::size_t size = cast.directions.size();
        std::size_t most = FlatPacket::kMax;
        int before_more = 0;
        for (std::size_t begin = 0; begin < size;) {
            const std::size_t count = std::min(most, size - begin);
            if (castPacket(cast, begin, count)) {
                begin += count;
                if (--before_more > 0 || most == FlatPacket::kMax) continue;
                most *= 2;
            } else if (count > FlatPacket::kBlock) {
                while (most >= count) most /= 2;
                before_more = 8;
            } else {
                for (const std::size_t end = begin + count; begin < end; ++begin)
                    castRay(cast, begin);
            }
        }
    }

    /// Casts beams begin .. begin + count - 1 of a scan.
    void castPart(const FlatView& view, const Directions& directions, const FlatLimit& limit,
                  std::size_t begin, std::size_t count, float* ranges, float* cosines) const {
        const double step = directions.arc->step.radians();
        const FlatBeams beams{directions.x.data() + begin,
                              directions.y.data() + begin,
                              static_cast<int>(count),
                              std::fabs(step),
                              ranges + begin,
                              cosines == nullptr ? nullptr : cosines + begin};
        step > 0 ? castScan(tree, view, limit, beams) : castReversed(view, limit, beams);
    }

    /// Casts beams at clockwise steps.
    [[gnu::noinline]] void castReversed(const FlatView& view, const FlatLimit& limit,
                                        const FlatBeams& beams) const {
        FlatBeams reversed = beams;
        double x[FlatScan::kMax], y[FlatScan::kMax];
        std::reverse_copy(beams.x, beams.x + beams.count, x);
        std::reverse_copy(beams.y, beams.y + beams.count, y);
        reversed.x = x;
        reversed.y = y;
        castScan(tree, view, limit, reversed);
        std::reverse(beams.ranges, beams.ranges + beams.count);
        if (beams.cosines != nullptr) std::reverse(beams.cosines, beams.cosines + beams.count);
    }
};

FlatWorld::FlatWorld(std::span<const Segment2> lines, std::span<const Ellipse> rounds)
    : data_(std::make_shared<const Data>(FlatTree(lines, rounds))) {}

FlatWorld::FlatWorld(const FlatWorld& base, const FlatBodies& removed, const FlatBodies& added)
    : data_(std::make_shared<const Data>(FlatTree(base.data_->tree, removed, added))) {}

void FlatWorld::cast(Point2 origin, const Directions& directions, double max_range,
                     double ray_epsilon, std::span<float> ranges, std::span<float> cosines) const {
    assert(ranges.size() == directions.size());
    assert(cosines.empty() || cosines.size() == directions.size());
    if (!(static_cast<float>(max_range) >= 0)) {
        std::fill(ranges.begin(), ranges.end(), kNoReturn);
        std::fill(cosines.begin(), cosines.end(), 1.0F);
        return;
    }
    const FlatLimit limit(max_range);
    const FlatView view{origin.x, origin.y, ray_epsilon};
    const std::size_t size = directions.size();
    if (isScan(directions) && data_->is_for_scan && isForScan(origin.x) && isForScan(origin.y)) {
        // Equal sizes, so that each part has enough beams.
        const std::size_t parts = (size + FlatScan::kMax - 1) / FlatScan::kMax;
        for (std::size_t part = 0; part < parts; ++part) {
            const std::size_t begin = size * part / parts, end = size * (part + 1) / parts;
            data_->castPart(view, directions, limit, begin, end - begin, ranges.data(),
                            cosines.empty() ? nullptr : cosines.data());
        }
        return;
    }
    data_->castRays({&origin, true, directions, ray_epsilon, limit, ranges.data(),
                     cosines.empty() ? nullptr : cosines.data()});
}

void FlatWorld::cast(std::span<const Point2> origins, const Directions& directions,
                     double max_range, double ray_epsilon, std::span<float> ranges,
                     std::span<float> cosines) const {
    assert(ranges.size() == directions.size() && origins.size() == directions.size());
    assert(cosines.empty() || cosines.size() == directions.size());
    if (!(static_cast<float>(max_range) >= 0)) {
        std::fill(ranges.begin(), ranges.end(), kNoReturn);
        std::fill(cosines.begin(), cosines.end(), 1.0F);
        return;
    }
    data_->castRays({origins.data(), false, directions, ray_epsilon, FlatLimit(max_range),
                     ranges.data(), cosines.empty() ? nullptr : cosines.data()});
}

}  // namespace ispace
