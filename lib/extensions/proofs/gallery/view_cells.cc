// SPDX-License-Identifier: GPL-3.0-or-later
// An index of views by cells, so that a point is tested against the views near it alone. Marks are
// convex hulls of parts of a view: supersets.
#include "extensions/proofs/gallery/view_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace ispace::proofs::gallery {

namespace {

struct Interval1 {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

/// Returns the y of the parts of segments between two x; empty (low > high) without one.
Interval1 stripOf(std::span<const Segment2> segments, double left, double right) {
    Interval1 strip;
    for (auto [a, b] : segments) {
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
    : side_(std::clamp<std::size_t>(floor.walls().size() / 16, 4, 128)) {
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
    const Polygon& outline = view.outline();
    const Point2 from = view.viewpoint();
    for (std::size_t i = 0; i < outline.size();) {
        Box2 box;
        box.add(outline[i]);
        const Point2 first = outline[i];
        // Edges within a cell's size count as their bounds.
        std::size_t edges = 0;
        while (i < outline.size()) {
            const Point2 next = outline[(i + 1) % outline.size()];
            Box2 wider = box;
            wider.add(next);
            if (edges > 0 && std::max(wider.width(), wider.depth()) > step_) break;
            box = wider;
            ++edges;
            ++i;
        }
        if (edges == 1) {
            const Point2 last = outline[i % outline.size()];
            mark(std::array{Segment2{from, first}, Segment2{from, last}, Segment2{first, last}});
            continue;
        }
        const Point2 low_right{box.high.x, box.low.y}, high_left{box.low.x, box.high.y};
        mark(std::array{Segment2{from, box.low}, Segment2{from, low_right},
                        Segment2{from, box.high}, Segment2{from, high_left},
                        Segment2{box.low, low_right}, Segment2{low_right, box.high},
                        Segment2{box.high, high_left}, Segment2{high_left, box.low}});
    }
    ++count_;
}

void ViewCells::mark(std::span<const Segment2> segments) {
    // Twice the clearance, since the ends of steep edges round.
    constexpr double kMargin = 2 * kClearance;
    Interval1 across;
    for (const Segment2& segment : segments) {
        across.add(segment.a.x);
        across.add(segment.b.x);
    }
    const std::size_t last = column(across.high + kMargin);
    for (std::size_t x = column(across.low - kMargin); x <= last; ++x) {
        const double left = box_.low.x + static_cast<double>(x) * step_;
        const Interval1 strip = stripOf(segments, left - kMargin, left + step_ + kMargin);
        if (strip.low > strip.high) continue;
        const std::size_t top = row(strip.high + kMargin);
        for (std::size_t y = row(strip.low - kMargin); y <= top; ++y) {
            std::vector<std::uint32_t>& cell = cells_[indexOf(x, y)];
            if (cell.empty() || cell.back() != count_) cell.push_back(count_);
        }
    }
}

}  // namespace ispace::proofs::gallery
