// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/box.h"
#include "geom/polygon.h"

namespace ispace {

/// True if the closed boxes share a point; an empty one meets nothing.
inline bool meets(const Box2& a, const Box2& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

/// Finds the boxes that meet a window: a binary tree of bounding boxes over their centres, halved
/// across the longer side. O(n log n) to build.
class BoxTree {
  public:
    BoxTree() = default;
    explicit BoxTree(std::span<const Box2> boxes);

    /// Calls visit(index) for each box that meets the window, in an order that depends only on the
    /// boxes. The visitor may shrink the window as it learns more.
    template <typename Visit>
    void search(const Box2& window, Visit visit) const;

  private:
    struct Node {
        Box2 box;
        std::uint32_t first, count;  // its leaves, in items_
        std::uint32_t right;         // the second child; the first one follows; 0: a leaf
    };
    static constexpr std::uint32_t kLeaf = 4;
    static constexpr std::size_t kDeepest = 64;  // halving 2^32 items, and more

    void build(std::uint32_t first, std::uint32_t count);

    std::vector<Box2> boxes_;
    std::vector<std::uint32_t> items_;
    std::vector<Node> nodes_;
};

template <typename Visit>
void BoxTree::search(const Box2& window, Visit visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kDeepest> open{};
    std::size_t count = 1;
    while (count > 0) {
        const std::uint32_t at = open[--count];
        const Node& node = nodes_[at];
        if (!meets(node.box, window)) continue;
        if (node.right != 0) {
            open[count++] = node.right;
            open[count++] = at + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            if (meets(boxes_[items_[i]], window)) visit(std::size_t{items_[i]});
    }
}

/// Finds the segments near others, however unevenly they are spread: a tree of their bounding
/// boxes, along the axes in which most of them run (so that a plan in any heading has thin boxes).
/// O(n log n) to build.
class SegmentTree {
  public:
    explicit SegmentTree(std::span<const Segment2> segments);

    /// Calls visit(index) once for each of some segments, in an order that depends only on the
    /// segments: among them are all that come within `reach` of the given one.
    template <typename Visit>
    void search(const Segment2& segment, double reach, Visit visit) const {
        tree_.search(boxOf(segment, reach), visit);
    }

  private:
    [[nodiscard]] Box2 boxOf(const Segment2& segment, double reach) const;

    Vec2 axis_{1, 0};   // unit, along which boxes lie
    double slack_ = 0;  // what turning may round away
    BoxTree tree_;
};

}  // namespace ispace
