// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>

#include "geom/point.h"

namespace ispace {

/// Axis-parallel rectangle on the floor; empty until a point is added.
struct Box2 {
    Point2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Point2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

    [[nodiscard]] bool empty() const { return low.x > high.x; }
    [[nodiscard]] double width() const { return high.x - low.x; }
    [[nodiscard]] double depth() const { return high.y - low.y; }
    [[nodiscard]] Point2 center() const {
        return {low.x + (high.x - low.x) / 2, low.y + (high.y - low.y) / 2};
    }
    void add(Point2 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    friend bool operator==(const Box2&, const Box2&) = default;
};

}  // namespace ispace
