// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_kernels.h"

#include <cmath>

#include "base/simd.h"
#include "trace/flat_shapes.h"

namespace ispace {

namespace {

constexpr int kWidth = FlatTree::kWidth;

struct Ray {
    double x, y;
};

/// More than kFlatEdge and what cross products with unit vectors round by.
ISPACE_INLINE double slackOf(double x, double y) {
    return 2 * kFlatEdge + 1e-12 * (std::fabs(x) + std::fabs(y));
}

/// Puts those children on the stack that the ray may meet, the nearest on top.
ISPACE_INLINE void visit(const FlatTree::Node& node, const FlatView& view, const Ray& ray,
                         const FlatHit& hit, FlatStack& stack) {
    alignas(64) double distance[kWidth];
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
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
        distance[i] = flatChoice(meets, near, -1.0);
    }
    stack.push(node, distance);
}

ISPACE_INLINE void meetLeaf(const FlatTree& tree, const FlatView& view, const FlatTree::Leaf& leaf,
                            const Ray& ray, FlatHit& hit) {
    alignas(64) double meets[kWidth];
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
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
    for (int i = 0; i < leaf.count; ++i) {
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

ISPACE_INLINE void meetRound(const FlatTree::Round& round, const FlatView& view, const Ray& ray,
                             FlatHit& hit) {
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
    const Ray ray{x, y};
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

}  // namespace ispace
