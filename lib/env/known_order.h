// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "geom/box_order.h"

namespace ispace {

/// How the lines of a slice are gathered for rays among them, which takes longest of all that is
/// made of it: found once, when a room is compiled. With a hash (XXH3, 128 bits) of the lines, so
/// that it is taken for them alone.
struct KnownOrder {
    std::uint64_t low = 0, high = 0;  ///< of the hash
    BoxOrder order;

    /// None of no lines, and where some are points. O(n log n)
    static KnownOrder of(std::span<const Segment2> lines);
    /// Null if these are other lines, bit by bit. O(n)
    [[nodiscard]] const BoxOrder* find(std::span<const Segment2> lines) const;
};

}  // namespace ispace
