// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/segment_grid.h"

#include <cmath>

namespace ispace {

SegmentGrid::SegmentGrid(std::span<const Segment2> segments, double margin) : margin_(margin) {
    double total = 0;
    for (const auto& [a, b] : segments) {
        box_.add(a);
        box_.add(b);
        total += distance(a, b);
    }
    if (segments.empty()) box_ = {{0, 0}, {0, 0}};
    const auto count = static_cast<double>(std::max<std::size_t>(1, segments.size()));
    // Not below the mean length, so that the lists stay short; a box of no width is cut in `count`.
    size_ = std::max({std::sqrt(box_.width() / count) * std::sqrt(box_.depth()), total / count,
                      std::max(box_.width(), box_.depth()) / count, 8 * margin_});
    if (!std::isfinite(size_)) size_ = std::numeric_limits<double>::max();
    const auto along = [&](double extent) {
        return extent / size_ < count ? static_cast<std::int64_t>(extent / size_) + 1
                                      : static_cast<std::int64_t>(count) + 1;
    };
    columns_ = along(box_.width());
    rows_ = along(box_.depth());

    // Count, then fill: the lists of all cells lie in one array.
    first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
    for (const Segment2& s : segments)
        forEachCellOf(s, [&](std::size_t cell) { ++first_[cell + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    indices_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        forEachCellOf(segments[i], [&](std::size_t cell) {
            indices_[next[cell]++] = static_cast<std::uint32_t>(i);
        });
    }
}

std::int64_t SegmentGrid::cellOf(double offset, std::int64_t count) const {
    const double cell = offset / size_;
    if (!(cell > 0)) return 0;
    return cell < static_cast<double>(count) ? static_cast<std::int64_t>(cell) : count - 1;
}

std::span<const std::uint32_t> SegmentGrid::cell(std::int64_t column, std::int64_t row) const {
    const auto i = static_cast<std::size_t>(row * columns_ + column);
    return std::span(indices_).subspan(first_[i], first_[i + 1] - first_[i]);
}

std::span<const std::uint32_t> SegmentGrid::near(Point2 p) const {
    return cell(column(p.x), row(p.y));
}

template <typename Visit>
void SegmentGrid::forEachCellOf(const Segment2& segment, Visit visit) const {
    auto [a, b] = segment;
    if (a.x > b.x) std::swap(a, b);
    const double low = std::min(a.y, b.y), high = std::max(a.y, b.y);
    // Generous by a part of a cell, so that rounding loses nothing.
    const double slack = margin_ + size_ / 1024;
    const double slope = (b.y - a.y) / (b.x - a.x);
    const std::int64_t last = column(b.x + slack);
    for (std::int64_t c = column(a.x - slack); c <= last; ++c) {
        double from = low, to = high;
        if (std::isfinite(slope)) {
            // The stretch of the segment over this column.
            const double left = box_.low.x + static_cast<double>(c) * size_ - slack;
            const double y0 = a.y + (left - a.x) * slope;
            const double y1 = a.y + (left + size_ + 2 * slack - a.x) * slope;
            from = std::max(low, std::min(y0, y1));
            to = std::min(high, std::max(y0, y1));
        }
        for (std::int64_t r = row(from - slack); r <= row(to + slack); ++r)
            visit(static_cast<std::size_t>(r * columns_ + c));
    }
}

}  // namespace ispace
