// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_contact.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "trace/flat_line.h"

namespace ispace {

namespace {

bool touches(const FlatTree::Leaf& leaf, int i, double ox, double oy, double contact) {
    const double ax = leaf.ax[i] - ox, ay = leaf.ay[i] - oy;
    const double ex = leaf.bx[i] - leaf.ax[i], ey = leaf.by[i] - leaf.ay[i];
    const double along = -(ax * ex + ay * ey) / (ex * ex + ey * ey);
    const double s = std::clamp(along, 0.0, 1.0);
    const double x = ax + s * ex, y = ay + s * ey;
    return x * x + y * y < contact * contact;
}

bool areParallel(const FlatTree::Leaf& leaf, int i, const FlatTree::Leaf& other, int j) {
    const double cosine = (leaf.bx[i] - leaf.ax[i]) * (other.bx[j] - other.ax[j]) +
                          (leaf.by[i] - leaf.ay[i]) * (other.by[j] - other.ay[j]);
    return std::fabs(cosine) >= kFlatParallel * leaf.length[i] * other.length[j];
}

bool isNear(const FlatTree::Node& node, int i, double ox, double oy, double contact) {
    return node.left[i] - ox <= contact && ox - node.right[i] <= contact &&
           node.low[i] - oy <= contact && oy - node.high[i] <= contact;
}

}  // namespace

bool continuesContact(const FlatTree& tree, const FlatTree::Leaf& leaf, int i, double ox, double oy,
                      double contact) {
    std::int32_t waiting[FlatTree::kStack];
    int count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const FlatTree::Node& node = tree.node(waiting[--count]);
        for (int k = 0; k < node.count; ++k) {
            if (!isNear(node, k, ox, oy, contact)) continue;
            if (node.child[k] >= 0) {
                waiting[count++] = node.child[k];
                continue;
            }
            const FlatTree::Leaf& near = tree.leaf(node.child[k]);
            for (int j = 0; j < near.count; ++j)
                if (areParallel(leaf, i, near, j) && touches(near, j, ox, oy, contact)) return true;
        }
    }
    return false;
}

}  // namespace ispace
