// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// How boxes are gathered into a tree.
struct BoxOrder {
    /// Children of a node, and boxes of a leaf, at most.
    static constexpr std::size_t kWidth = 8;
    /// Nodes below each other, at most.
    static constexpr int kDepth = 24;

    /// Indices of the boxes, leaf after leaf as one comes to them from the root, first children
    /// first.
    std::vector<std::uint32_t> items;
    /// Of each node, the root first: the number of its children; of each child the number of its
    /// boxes if it is a leaf, 0 if it is a node; then all this of each child that is one.
    std::vector<std::uint8_t> shape;
};

/// By binned surface area heuristic, with up to `most` boxes a leaf. O(n log n)
/// \pre most <= BoxOrder::kWidth, and there are boxes
BoxOrder orderOf(std::span<const Box2> boxes, std::size_t most);
/// The same of the boxes of lines, BoxOrder::kWidth a leaf. \pre there are lines
BoxOrder orderOf(std::span<const Segment2> lines);

}  // namespace ispace
