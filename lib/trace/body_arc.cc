// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/body_arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "trace/flat_kernels.h"

namespace ispace {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Radians added to each side of a body as a sensor sees it: more than angleOf() errs three times.
constexpr double kAngularSlack = 5e-5;

/// Kept for its memory: threads read many scans.
std::vector<float>& farthestOfThread() {
    thread_local std::vector<float> farthest;
    return farthest;
}

}  // namespace

BodyArc::BodyArc(Point3 origin, const Directions& directions, double max_range,
                 std::span<const MovingBody> bodies, std::span<const BodyExtent> extents,
                 const ShortenedRanges& ranges)
    : origin_(origin),
      directions_(directions),
      bodies_(bodies),
      extents_(extents),
      far_(max_range),
      most_(static_cast<float>(max_range * (1 + kFarSlack))),
      ranges_(ranges),
      count_(static_cast<double>(directions.size())),
      farthest_(farthestOfThread()) {
    const auto& [first, step] = *directions.arc;
    middle_ = cosSin(first + ((count_ - 1) / 2) * step);
    rate_ = 1 / step.radians();
    farthest_.resize((directions.size() + kBlock - 1) / kBlock);
    for (std::size_t block = 0; block < farthest_.size(); ++block) findFarthest(block);
}

void BodyArc::findFarthest(std::size_t block) {
    const std::size_t begin = block * kBlock, end = std::min(begin + kBlock, directions_.size());
    float farthest = 0;
    for (std::size_t k = begin; k < end; ++k) farthest = std::max(farthest, ranges_[k]);
    farthest_[block] = std::min(farthest, most_);
}

Box2 BodyArc::view() const {
    Box2 box;
    box.add(origin_.onFloor());
    constexpr double kWide = 1;  // radians
    const double half = (kBlock - 1) / (2 * rate_);
    if (half > kWide) {
        const Vec2 margin{far_ * (1 + kFarSlack), far_ * (1 + kFarSlack)};
        return {origin_.onFloor() - margin, origin_.onFloor() + margin};
    }
    // The ends of a block, so far away that the chord between them lies behind its arc.
    const double beyond = (1 + kFarSlack) / std::cos(half);
    for (std::size_t block = 0; block < farthest_.size(); ++block) {
        const double far = static_cast<double>(farthest_[block]) * beyond;
        const std::size_t begin = block * kBlock;
        for (const std::size_t k : {begin, std::min(begin + kBlock, directions_.size()) - 1})
            box.add(origin_.onFloor() + far * Vec2{directions_.x[k], directions_.y[k]});
    }
    return box;
}

void BodyArc::meetFrom(const FloorGrid& grid, std::uint32_t own) {
    // A few cells at first, then four times as many each time.
    constexpr double kCells = 2.5;
    const auto within = [](const Box2& a, const Box2& b) {
        return Box2{{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
                    {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
    };
    Box2 done;
    for (double half = kCells * grid.cellSize();; half *= 2) {
        const Point2 middle = origin_.onFloor();
        const Box2 view = this->view();
        const Box2 box = within(view, {middle - Vec2{half, half}, middle + Vec2{half, half}});
        grid.forEachRun(box, done, [&](std::size_t begin, std::size_t end) {
            look(grid.order().subspan(begin, end - begin), own);
        });
        meetCollected();
        if (box.low == view.low && box.high == view.high) return;
        done = box;
    }
}

bool BodyArc::isSeen(std::int32_t first, std::int32_t last, double nearest) const {
    if (first > last) return false;
    const auto begin = static_cast<std::size_t>(first) / kBlock;
    const auto end = static_cast<std::size_t>(last) / kBlock;
    for (std::size_t block = begin; block <= end; ++block)
        if (static_cast<double>(farthest_[block]) > nearest) return true;
    return false;
}

bool BodyArc::isSeen(const Waiting& waiting) const {
    return isSeen(waiting.first, waiting.last, waiting.nearest) ||
           isSeen(waiting.other_first, waiting.other_last, waiting.nearest);
}

void BodyArc::look(std::span<const std::uint32_t> bodies, std::uint32_t own) {
    const auto beam = [&](double angle) {
        return static_cast<std::int32_t>(
            flatMin(flatMax(angle * rate_ + (count_ - 1) * 0.5 + 1, 0.0), count_));
    };
    for (const std::uint32_t i : bodies) {
        const MovingBody& body = bodies_[i];
        const BodyExtent& extent = extents_[i];
        if (origin_.z < body.bottom || origin_.z > body.top || body.owner == own) continue;
        const double lean = body.lean * (origin_.z - body.middle());
        const Vec2 way =
            body.pose.position - origin_.onFloor() + lean * Vec2{extent.axes.cos, extent.axes.sin};
        const double square = dot(way, way), distance = std::sqrt(square);
        Waiting waiting{distance - extent.reach, i, 0, -1, 0, -1};
        if (waiting.nearest > far_ * (1 + kFarSlack)) continue;
        const double wide = extent.reach * (1 + kFarSlack);
        const double angle = angleOf(way.x * middle_.cos + way.y * middle_.sin,
                                     way.y * middle_.cos - way.x * middle_.sin);
        // Half of the angle that its circle takes up; all of the turn from within.
        const double tangent = std::sqrt(std::max(square - wide * wide, 0.0));
        const double half = distance <= wide ? kTurn : angleOf(tangent, wide) + kAngularSlack;
        const double from = angle - half, to = angle + half;
        waiting.first = beam(from);
        waiting.last = beam(to) - 1;
        // A body across the cut of the turn, behind the middle, is at the other end, too.
        const double shift = to > std::numbers::pi ? -kTurn : kTurn;
        if (to > std::numbers::pi || from < -std::numbers::pi) {
            waiting.other_first = beam(from + shift);
            waiting.other_last = beam(to + shift) - 1;
        }
        if (!isSeen(waiting)) continue;
        if (size_ == kMost) meetCollected();
        waiting_[size_++] = waiting;
    }
}

void BodyArc::meetCollected() {
    std::sort(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(size_),
              [](const Waiting& a, const Waiting& b) { return a.nearest < b.nearest; });
    for (std::size_t i = 0; i < size_; ++i) {
        const Waiting& waiting = waiting_[i];
        if (!isSeen(waiting)) continue;
        const BodyFrom body(bodies_[waiting.body], extents_[waiting.body].axes, origin_);
        meetBeams(body, waiting.first, waiting.last, waiting.nearest);
        meetBeams(body, waiting.other_first, waiting.other_last, waiting.nearest);
    }
    size_ = 0;
}

void BodyArc::meetBeams(const BodyFrom& body, std::int32_t first, std::int32_t last,
                        double nearest) {
    if (first > last) return;
    const auto begin = static_cast<std::size_t>(first), end = static_cast<std::size_t>(last) + 1;
    for (std::size_t k = begin; k < end; ++k)
        if (static_cast<double>(ranges_[k]) > nearest)
            ranges_.shorten(k, body.meet(directions_[k]), 1);
    for (std::size_t block = begin / kBlock; block * kBlock < end; ++block) findFarthest(block);
}

}  // namespace ispace
