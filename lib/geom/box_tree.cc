// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/box_tree.h"

#include <algorithm>

namespace ispace {

BoxTree::BoxTree(std::span<const Box2> boxes) : boxes_(boxes.begin(), boxes.end()) {
    items_.reserve(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        if (!boxes[i].empty()) items_.push_back(i);
    if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
}

void BoxTree::build(std::uint32_t first, std::uint32_t count) {
    Box2 box;
    for (std::uint32_t i = first; i < first + count; ++i) {
        box.add(boxes_[items_[i]].low);
        box.add(boxes_[items_[i]].high);
    }
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({box, first, count, 0});
    if (count <= kLeaf) return;
    const bool is_wide = box.width() >= box.depth();
    const auto place = [&](std::uint32_t item) {
        const Point2 center = boxes_[item].center();
        return is_wide ? center.x : center.y;
    };
    const std::uint32_t half = count / 2;
    std::nth_element(items_.begin() + first, items_.begin() + first + half,
                     items_.begin() + first + count, [&](std::uint32_t a, std::uint32_t b) {
                         const double x = place(a), y = place(b);
                         return x < y || (x == y && a < b);
                     });
    build(first, half);  // depth is the logarithm of the number
    nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
    build(first + half, count - half);
}

}  // namespace ispace
