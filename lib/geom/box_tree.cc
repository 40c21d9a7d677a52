// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
