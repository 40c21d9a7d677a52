// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/spatial_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ispace {

std::uint64_t mortonCode(std::uint32_t x, std::uint32_t y) {
    const auto spread = [](std::uint64_t bits) {  // to every second place
        bits = (bits | bits << 16U) & 0x0000FFFF0000FFFFU;
        bits = (bits | bits << 8U) & 0x00FF00FF00FF00FFU;
        bits = (bits | bits << 4U) & 0x0F0F0F0F0F0F0F0FU;
        bits = (bits | bits << 2U) & 0x3333333333333333U;
        return (bits | bits << 1U) & 0x5555555555555555U;
    };
    return spread(x) | spread(y) << 1U;
}

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

namespace {

/// Coordinates beyond this are not turned: their products would overflow.
constexpr double kFarthestTurned = 1e100;

/// The direction, modulo a right angle, in which the segments run, weighted by length.
Vec2 mainAxis(std::span<const Segment2> segments) {
    // Four times the angle is the same for all sides of a rectangle: sum its unit vectors.
    Vec2 sum{0, 0};
    for (const auto& [a, b] : segments) {
        const double apart = distance(a, b);
        if (!(apart > 0)) continue;
        const Vec2 unit = (1 / apart) * (b - a);
        const Vec2 twice{unit.x * unit.x - unit.y * unit.y, 2 * unit.x * unit.y};
        sum = sum + apart * Vec2{twice.x * twice.x - twice.y * twice.y, 2 * twice.x * twice.y};
    }
    const double angle = std::atan2(sum.y, sum.x) / 4;
    return {std::cos(angle), std::sin(angle)};
}

}  // namespace

SegmentTree::SegmentTree(std::span<const Segment2> segments) {
    double farthest = 0;
    for (const auto& [a, b] : segments)
        farthest = std::max({farthest, std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y)});
    if (farthest <= kFarthestTurned) axis_ = mainAxis(segments);
    slack_ = 8 * std::numeric_limits<double>::epsilon() * farthest;
    std::vector<Box2> boxes;
    boxes.reserve(segments.size());
    for (const Segment2& segment : segments) boxes.push_back(boxOf(segment, 0));
    tree_ = BoxTree(boxes);
}

Box2 SegmentTree::boxOf(const Segment2& segment, double reach) const {
    Box2 box;
    for (const Point2 p : {segment.a, segment.b})
        box.add({axis_.x * p.x + axis_.y * p.y, axis_.x * p.y - axis_.y * p.x});
    const Vec2 margin{reach + slack_, reach + slack_};
    return {box.low - margin, box.high + margin};
}

}  // namespace ispace
