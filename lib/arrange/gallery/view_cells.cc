// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/gallery/view_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ispace::gallery {

namespace {

struct Interval1 {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

/// Returns the y of the part of a triangle between two x; empty (low > high) without one.
Interval1 stripOf(const std::array<Point2, 3>& triangle, double left, double right) {
    Interval1 strip;
    for (std::size_t i = 0; i < 3; ++i) {
        Point2 a = triangle[i], b = triangle[(i + 1) % 3];
        if (b.x < a.x) std::swap(a, b);
        if (b.x < left || a.x > right) continue;
        const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
        strip.add(a.x < left ? a.y + slope * (left - a.x) : a.y);
        strip.add(b.x > right ? a.y + slope * (right - a.x) : b.y);
    }
    return strip;
}

}  // namespace

ViewCells::ViewCells(const Floor& floor)
    : side_(std::clamp<std::size_t>(floor.walls().size() / 8, 4, 256)) {
    for (const Segment2& wall : floor.walls()) {
        box_.add(wall.a);
        box_.add(wall.b);
    }
    step_ = std::max({box_.width(), box_.depth(), 1.0}) / static_cast<double>(side_);
    cells_.resize(side_ * side_);
}

std::size_t ViewCells::cellOf(double offset) const {
    const double cell = std::floor(offset / step_);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(side_ - 1)));
}

void ViewCells::add(const StarView& view) {
    // Twice the clearance, since the ends of steep edges round.
    constexpr double kMargin = 2 * kClearance;
    const Polygon& outline = view.outline();
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const std::array<Point2, 3> part = {view.viewpoint(), outline[i],
                                            outline[(i + 1) % outline.size()]};
        const auto [low, high] = std::minmax({part[0].x, part[1].x, part[2].x});
        const std::size_t last = column(high + kMargin);
        for (std::size_t x = column(low - kMargin); x <= last; ++x) {
            const double left = box_.low.x + static_cast<double>(x) * step_;
            const Interval1 strip = stripOf(part, left - kMargin, left + step_ + kMargin);
            if (strip.low > strip.high) continue;
            const std::size_t top = row(strip.high + kMargin);
            for (std::size_t y = row(strip.low - kMargin); y <= top; ++y) {
                std::vector<std::uint32_t>& cell = cells_[indexOf(x, y)];
                if (cell.empty() || cell.back() != count_) cell.push_back(count_);
            }
        }
    }
    ++count_;
}

}  // namespace ispace::gallery
