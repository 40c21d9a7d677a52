// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_ray.h"

#include <cmath>
#include <cstdint>

#include "base/simd.h"
#include "trace/flat_contact.h"
#include "trace/flat_line.h"

namespace ispace {

namespace {

constexpr int kWidth = FlatTree::kWidth;

struct Ray {
    double x, y;
};

struct Waiting {
    double distance;
    std::int32_t child;
};

struct Stack {
    Waiting entries[FlatTree::kStack];
    int count = 0;
};

/// More than kFlatEdge and what cross products with unit vectors round by.
ISPACE_INLINE double slackOf(double x, double y) {
    return 2 * kFlatEdge + 1e-12 * (std::fabs(x) + std::fabs(y));
}

/// False if nothing at this distance or beyond is as near as what was met, whatever the rounding.
bool mayBeNearer(double distance, const FlatHit& hit) {
    return distance * hit.nearness <= 1 + 1e-12;
}

/// Puts those children on the stack that the ray may meet, the nearest on top.
ISPACE_INLINE void visit(const FlatTree::Node& node, const FlatView& view, const Ray& ray,
                         const FlatHit& hit, Stack& stack) {
    alignas(64) double distance[kWidth];
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        const double left = node.left[i] - view.x, right = node.right[i] - view.x;
        const double low = node.low[i] - view.y, high = node.high[i] - view.y;
        // The ray passes the box if corners lie on both of its sides, and one is ahead.
        const double p = ray.x * low, q = ray.x * high, r = ray.y * left, s = ray.y * right;
        const double right_side = flatLess(p, q) - flatMore(r, s);
        const double left_side = flatMore(p, q) - flatLess(r, s);
        const double ahead =
            flatMore(ray.x * left, ray.x * right) + flatMore(ray.y * low, ray.y * high);
        const double slack = slackOf(flatMore(std::fabs(left), std::fabs(right)),
                                     flatMore(std::fabs(low), std::fabs(high)));
        const bool meets = (right_side <= slack) & (left_side >= -slack) & (ahead >= -slack);
        distance[i] = flatChoice(meets, distanceOf(left, right, low, high), -1.0);
    }
    const int bottom = stack.count;
    for (int i = 0; i < node.count; ++i) {
        if (distance[i] < 0 || !mayBeNearer(distance[i], hit)) continue;
        int place = stack.count++;
        for (; place > bottom && stack.entries[place - 1].distance < distance[i]; --place)
            stack.entries[place] = stack.entries[place - 1];
        stack.entries[place] = {distance[i], node.child[i]};
    }
}

ISPACE_INLINE void meetLeaf(const FlatTree& tree, const FlatView& view, const FlatTree::Leaf& leaf,
                            const Ray& ray, FlatHit& hit) {
    alignas(64) double slack[kWidth];
    ISPACE_LANES for (int i = 0; i < kWidth; ++i) {
        const double px = leaf.ax[i] - view.x, py = leaf.ay[i] - view.y;
        const double qx = leaf.bx[i] - view.x, qy = leaf.by[i] - view.y;
        const double p = ray.x * py - ray.y * px, q = ray.x * qy - ray.y * qx;
        const double most =
            slackOf(flatMore(std::fabs(px), std::fabs(qx)), flatMore(std::fabs(py), std::fabs(qy)));
        // Not negative if ends lie on both sides of the ray's line.
        slack[i] = flatLess(most - flatLess(p, q), most + flatMore(p, q));
    }
    for (int i = 0; i < leaf.count; ++i) {
        if (slack[i] < 0) continue;
        const FlatLine line = lineFrom(leaf, i, view.x, view.y);
        const double nearness = nearnessAlong(line, ray.x, ray.y);
        if (!line.stops || nearness < hit.nearness || nearness <= 0) continue;
        const double cosine = nearness * line.height;
        if (nearness == hit.nearness && cosine <= hit.cosine) continue;
        if (mayContinueContact(line.height, view.contact) &&
            continuesContact(tree, leaf, i, view.x, view.y, view.contact))
            continue;
        hit = {nearness, cosine};
    }
}

}  // namespace

ISPACE_SIMD_CLONES
FlatHit firstLine(const FlatTree& tree, const FlatView& view, double x, double y,
                  double least_nearness) {
    FlatHit hit{least_nearness};
    if (tree.nodes.empty()) return hit;
    const Ray ray{x, y};
    Stack stack;
    visit(tree.nodes.front(), view, ray, hit, stack);
    while (stack.count > 0) {
        const Waiting box = stack.entries[--stack.count];
        if (!mayBeNearer(box.distance, hit)) continue;
        if (box.child >= 0)
            visit(tree.node(box.child), view, ray, hit, stack);
        else
            meetLeaf(tree, view, tree.leaf(box.child), ray, hit);
    }
    return hit;
}

}  // namespace ispace
