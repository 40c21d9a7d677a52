// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/body_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/per_thread.h"
#include "trace/flat_kernels.h"

namespace ispace {

namespace {

/// The minimal range of pixels around some points, for one axis.
struct PixelRange {
    double low = std::numeric_limits<double>::infinity(), high = -low;

    void add(double pixel) {
        low = std::min(low, pixel);
        high = std::max(high, pixel);
    }
    // Rounding of a projection is far less than this.
    static constexpr double kSlack = 1e-3;
    [[nodiscard]] int first(int count) const {
        return static_cast<int>(
            std::clamp(std::ceil(low - kSlack), 0.0, static_cast<double>(count)));
    }
    /// End of the range, exclusive.
    [[nodiscard]] int last(int count) const {
        return static_cast<int>(
            std::clamp(std::floor(high + kSlack) + 1, 0.0, static_cast<double>(count)));
    }
};

/// Corners of a box around the body, with the same lean; corner i + 4 lies above corner i.
std::array<Vec3, 8> cornersOf(const MovingBody& body, const BodyExtent& extent, Point3 origin) {
    const bool is_round = body.radius > 0;
    const double half_length = is_round ? body.radius : body.half_length;
    const double half_width = is_round ? body.radius : body.half_width;
    const Vec2 along = half_length * Vec2{extent.axes.cos, extent.axes.sin};
    const Vec2 across = half_width * Vec2{-extent.axes.sin, extent.axes.cos};
    const Vec2 middle = body.pose.position - origin.onFloor();
    const Vec2 floor[] = {middle + along + across, middle - along + across, middle - along - across,
                          middle + along - across};
    const Vec2 ahead =
        body.lean * (body.top - body.middle()) * Vec2{extent.axes.cos, extent.axes.sin};
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 low = floor[i] - ahead, high = floor[i] + ahead;
        corners[i] = {low.x, low.y, body.bottom - origin.z};
        corners[i + 4] = {high.x, high.y, body.top - origin.z};
    }
    return corners;
}

}  // namespace

BodyScan::BodyScan(std::span<const Point3> origins, const Directions& directions, std::size_t begin,
                   std::size_t end, double max_range, const ShortenedRanges& ranges)
    : origins_(origins),
      is_one_(origins.size() == 1),
      directions_(directions),
      begin_(begin),
      end_(end),
      ranges_(ranges),
      low_(std::numeric_limits<double>::infinity()),
      high_(-low_) {
    const double most = max_range * (1 + kFloatTolerance);
    Box2 origin_box;
    for (std::size_t k = begin; k < end; k += is_one_ ? end - begin : 1)
        origin_box.add(origin(k).onFloor());
    middle_ = origin_box.center();
    spread_ =
        0.5 * std::sqrt(dot(origin_box.high - origin_box.low, origin_box.high - origin_box.low));
    box_ = origin_box;
    Vec2 ahead;
    for (std::size_t k = begin; k < end; ++k) {
        const double far = std::min(
            static_cast<double>(ranges_[k]) * (1 + kFloatTolerance) + kFloatTolerance, most);
        const Point3 from = origin(k);
        const double rise = from.z + far * directions.z[k];
        const Vec2 flat{directions.x[k], directions.y[k]};
        reach_ = std::max(reach_, far);
        low_ = std::min({low_, from.z, rise});
        high_ = std::max({high_, from.z, rise});
        box_.add(from.onFloor() + far * flat);
        ahead = ahead + flat;
    }
    Vec2 right = ahead, left = ahead;
    for (std::size_t k = begin; k < end; ++k) {
        const Vec2 flat{directions.x[k], directions.y[k]};
        // Within some 84 degrees: upright rays have no direction on the floor.
        if (!(dot(ahead, flat) > 0.1 * std::fabs(cross(ahead, flat)))) return;
        if (cross(right, flat) < 0) right = flat;
        if (cross(left, flat) > 0) left = flat;
    }
    right_ = 1 / std::sqrt(dot(right, right)) * right;
    left_ = 1 / std::sqrt(dot(left, left)) * left;
}

void BodyScan::meet(const MovingBody& body, const BodyExtent& extent) {
    const double radius = extent.whole * (1 + kFloatTolerance) + kFloatTolerance;
    const Vec2 there = body.pose.position - middle_;
    const double around = radius + spread_, far = around + reach_;
    if (body.bottom > high_ || body.top < low_ || cross(right_, there) < -around ||
        cross(left_, there) > around || dot(there, there) > far * far)
        return;
    for (std::size_t k = begin_; k < end_; ++k) {
        // Most rays miss the circle about it, or end before it.
        const Point3 from = origin(k);
        const Vec2 way = body.pose.position - from.onFloor();
        const Vec2 flat{directions_.x[k], directions_.y[k]};
        const double size = dot(flat, flat), aside = cross(way, flat);
        const double end = static_cast<double>(ranges_[k]) + radius;
        if (aside * aside > radius * radius * size + 1e-12 || dot(way, way) > end * end) continue;
        ranges_.shorten(k, BodyFrame(body, extent.axes, from).meet(directions_[k]), 1);
    }
}

BodyPicture::BodyPicture(Point3 origin, const RayGrid& grid, double most,
                         const ShortenedRanges& ranges)
    : origin_(origin), grid_(grid), ranges_(ranges) {
    double longest = 0;
    for (const int column : {0, grid.columns - 1})
        for (const int row : {0, grid.rows - 1})
            longest = std::max(longest, length(grid.ray(column, row)));
    far_ = most * longest;
    // The rows of the inverse of the matrix of right, down and corner.
    const Vec3 by_right = cross(grid.down, grid.corner);
    const Vec3 by_down = cross(grid.corner, grid.right);
    const Vec3 by_corner = cross(grid.right, grid.down);
    const double volume = dot(grid.right, by_right);
    const double size = length(grid.right) * length(grid.down) * length(grid.corner);
    is_plane_ = std::fabs(volume) > 1e-9 * size;
    if (!is_plane_) return;
    to_right_ = (1 / volume) * by_right;
    to_down_ = (1 / volume) * by_down;
    to_corner_ = (1 / volume) * by_corner;
}

Box2 BodyPicture::box() const {
    const Point2 middle = origin_.onFloor();
    const Vec2 corner{far_ * (1 + kFloatTolerance), far_ * (1 + kFloatTolerance)};
    return {middle - corner, middle + corner};
}

PixelBox BodyPicture::pixelsOf(const MovingBody& body, const BodyExtent& extent) const {
    const PixelBox all{0, 0, grid_.columns, grid_.rows};
    if (!is_plane_) return all;
    const Vec2 way = origin_.onFloor() - body.pose.position;
    const double near = 1e-6 + kFloatTolerance * extent.whole;
    if (length(way) <= extent.whole + near && origin_.z >= body.bottom - near &&
        origin_.z <= body.top + near)
        return all;

    std::array<Vec3, 8> corners = cornersOf(body, extent, origin_);
    double depth = 0;
    for (Vec3& corner : corners) {
        corner = projected(corner);
        depth = std::max(depth, corner.z);
    }
    // The part in front of the picture's eye, cut off at a small distance.
    const double front = 1e-9 * depth;
    PixelRange columns, rows;
    const auto add = [&](Vec3 p) {
        columns.add(p.x / p.z);
        rows.add(p.y / p.z);
    };
    const auto add_edge = [&](Vec3 p, Vec3 q) {
        if ((p.z < front) == (q.z < front)) return;
        const double share = (front - p.z) / (q.z - p.z);
        add({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y), front});
    };
    if (!(depth > 0)) return {};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (corners[i].z >= front) add(corners[i]);
        add_edge(corners[i], corners[i < 4 ? (i + 1) % 4 : 4 + (i + 1) % 4]);
        if (i < 4) add_edge(corners[i], corners[i + 4]);
    }
    return {columns.first(grid_.columns), rows.first(grid_.rows), columns.last(grid_.columns),
            rows.last(grid_.rows)};
}

void BodyPicture::meet(const MovingBody& body, const BodyExtent& extent) {
    const PixelBox pixels = pixelsOf(body, extent);
    const BodyFrame from(body, extent.axes, origin_);
    for (int row = pixels.top; row < pixels.bottom; ++row) {
        for (int column = pixels.left; column < pixels.right; ++column) {
            const Vec3 ray = grid_.ray(column, row);
            const RayHit met = from.meet(ray);
            if (met.multiple == std::numeric_limits<double>::infinity()) continue;
            const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.columns) +
                           static_cast<std::size_t>(column);
            ranges_.shorten(i, met, std::sqrt(dot(ray, ray)));
        }
    }
}

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
/// Margin in radians on each side of a body: more than three times the error of angleOf().
constexpr double kAngularSlack = 5e-5;

/// Kept to reuse its memory: threads read many scans.
std::vector<float>& farthestOfThread() { return perThread<std::vector<float>, struct Farthest>(); }

}  // namespace

BodyArc::BodyArc(Point3 origin, const Directions& directions, double max_range,
                 std::span<const MovingBody> bodies, std::span<const BodyExtent> extents,
                 const ShortenedRanges& ranges)
    : origin_(origin),
      directions_(directions),
      bodies_(bodies),
      extents_(extents),
      far_(max_range),
      most_(static_cast<float>(max_range * (1 + kFloatTolerance))),
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
        const Vec2 margin{far_ * (1 + kFloatTolerance), far_ * (1 + kFloatTolerance)};
        return {origin_.onFloor() - margin, origin_.onFloor() + margin};
    }
    // Ends of a block, so distant that the chord between them lies beyond its arc.
    const double beyond = (1 + kFloatTolerance) / std::cos(half);
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
        if (waiting.nearest > far_ * (1 + kFloatTolerance)) continue;
        const double wide = extent.reach * (1 + kFloatTolerance);
        const double angle = angleOf(way.x * middle_.cos + way.y * middle_.sin,
                                     way.y * middle_.cos - way.x * middle_.sin);
        // Half the angle of its circle; a full turn from inside.
        const double tangent = std::sqrt(std::max(square - wide * wide, 0.0));
        const double half = distance <= wide ? kTurn : angleOf(tangent, wide) + kAngularSlack;
        const double from = angle - half, to = angle + half;
        waiting.first = beam(from);
        waiting.last = beam(to) - 1;
        // A body across the cut of the turn, behind the middle, also appears at the other end.
        const double shift = to > std::numbers::pi ? -kTurn : kTurn;
        if (to > std::numbers::pi || from < -std::numbers::pi) {
            waiting.other_first = beam(from + shift);
            waiting.other_last = beam(to + shift) - 1;
        }
        if (!isSeen(waiting)) continue;
        if (size_ == kMaxWaiting) meetCollected();
        waiting_[size_++] = waiting;
    }
}

void BodyArc::meetCollected() {
    std::sort(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(size_),
              [](const Waiting& a, const Waiting& b) { return a.nearest < b.nearest; });
    for (std::size_t i = 0; i < size_; ++i) {
        const Waiting& waiting = waiting_[i];
        if (!isSeen(waiting)) continue;
        const BodyFrame body(bodies_[waiting.body], extents_[waiting.body].axes, origin_);
        meetBeams(body, waiting.first, waiting.last, waiting.nearest);
        meetBeams(body, waiting.other_first, waiting.other_last, waiting.nearest);
    }
    size_ = 0;
}

void BodyArc::meetBeams(const BodyFrame& body, std::int32_t first, std::int32_t last,
                        double nearest) {
    if (first > last) return;
    const auto begin = static_cast<std::size_t>(first), end = static_cast<std::size_t>(last) + 1;
    for (std::size_t k = begin; k < end; ++k)
        if (static_cast<double>(ranges_[k]) > nearest)
            ranges_.shorten(k, body.meet(directions_[k]), 1);
    for (std::size_t block = begin / kBlock; block * kBlock < end; ++block) findFarthest(block);
}

}  // namespace ispace
