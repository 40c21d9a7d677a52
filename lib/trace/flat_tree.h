// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/curve.h"
#include "geom/polygon.h"

namespace ispace {

/// A bounding volume hierarchy over lines on the floor, with eight boxes or lines per node, one
/// array per component, as vector units want them. Lines without length are left out. Round bodies
/// have a hierarchy of their own in the same nodes, to be traversed after that of the lines.
struct FlatTree {
    static constexpr int kWidth = 8;
    /// Greatest depth; traversals keep fewer than kWidth nodes per level waiting.
    static constexpr int kDepth = 24;
    static constexpr int kStack = kWidth * kDepth;

    /// Child i is node child[i], or leaf ~child[i] if that is negative. Boxes beyond `count` repeat
    /// the first one.
    struct alignas(64) Node {
        double left[kWidth], right[kWidth], low[kWidth], high[kWidth];
        std::int32_t child[kWidth];
        std::int32_t count;
    };
    /// Up to kWidth lines; what lies behind them has no length. a lies before b by lexLess, so that
    /// a line and its reverse are computed with alike.
    struct alignas(64) Leaf {
        double ax[kWidth], ay[kWidth], bx[kWidth], by[kWidth], length[kWidth];

        /// Of the lines.
        [[nodiscard]] int count() const {
            int lines = 0;
            for (const double one : length) lines += one > 0 ? 1 : 0;
            return lines;
        }
    };

    /// The map of a round body's plane that makes it the unit disc: from (x - cx, y - cy).
    struct Round {
        double cx, cy, xx, xy, yx, yy;
    };

    /// Lines that are points are left out. O(n log n)
    explicit FlatTree(std::span<const Segment2> lines, std::span<const Ellipse> round_bodies = {});

    /// Of a child.
    [[nodiscard]] const Node& node(std::int32_t child) const {
        return nodes[static_cast<std::uint32_t>(child)];
    }
    [[nodiscard]] const Leaf& leaf(std::int32_t child) const {
        return leaves[~static_cast<std::uint32_t>(child)];
    }

    /// Child of a node among those of round bodies.
    [[nodiscard]] const Round& round(std::int32_t child) const {
        return rounds[~static_cast<std::uint32_t>(child)];
    }

    /// The first is the root of the lines, without children if there are none; no nodes at all
    /// without lines and round bodies.
    std::vector<Node> nodes;
    std::vector<Leaf> leaves;
    std::int32_t round_root = -1;  ///< of the round bodies, whose leaves are one each; -1: none
    std::vector<Round> rounds;
};

}  // namespace ispace
