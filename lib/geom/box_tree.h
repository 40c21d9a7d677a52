// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/box.h"

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

    void build(std::uint32_t first, std::uint32_t count);

    std::vector<Box2> boxes_;
    std::vector<std::uint32_t> items_;
    std::vector<Node> nodes_;
};

template <typename Visit>
void BoxTree::search(const Box2& window, Visit visit) const {
    if (nodes_.empty()) return;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const std::uint32_t at = open.back();
        const Node& node = nodes_[at];
        open.pop_back();
        if (!meets(node.box, window)) continue;
        if (node.right != 0) {
            open.push_back(node.right);
            open.push_back(at + 1);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            if (meets(boxes_[items_[i]], window)) visit(std::size_t{items_[i]});
    }
}

}  // namespace ispace
