// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// A bounding volume hierarchy over lines on the floor, eight boxes or lines a node, each component
/// an array: what a vector unit takes at once. Lines without length are left out.
struct FlatTree {
    static constexpr int kWidth = 8;
    /// How many nodes lie above one another at most; traversals keep fewer than kWidth waiting a
    /// level.
    static constexpr int kDepth = 24;
    static constexpr int kStack = kWidth * kDepth;

    /// Child i is node child[i], or leaf ~child[i] if that is negative. Boxes beyond `count` repeat
    /// the first one.
    struct alignas(64) Node {
        double left[kWidth], right[kWidth], low[kWidth], high[kWidth];
        std::int32_t child[kWidth];
        std::int32_t count;
    };
    /// Lines beyond `count` have no length. a lies before b by lexLess, so that a line and its
    /// reverse are computed with alike.
    struct alignas(64) Leaf {
        double ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth], length[kWidth];
        std::int32_t count;
    };

    /// By binned surface area heuristic. O(n log n)
    explicit FlatTree(std::span<const Segment2> lines);

    /// Of a child.
    [[nodiscard]] const Node& node(std::int32_t child) const {
        return nodes[static_cast<std::uint32_t>(child)];
    }
    [[nodiscard]] const Leaf& leaf(std::int32_t child) const {
        return leaves[~static_cast<std::uint32_t>(child)];
    }

    std::vector<Node> nodes;  ///< the first is the root; none if there are no lines
    std::vector<Leaf> leaves;
};

}  // namespace ispace
