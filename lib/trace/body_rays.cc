// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/body_rays.h"

#include <array>

namespace ispace {

namespace {

/// The smallest range of pixels about some places, for one axis.
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
    /// One past the last.
    [[nodiscard]] int last(int count) const {
        return static_cast<int>(
            std::clamp(std::floor(high + kSlack) + 1, 0.0, static_cast<double>(count)));
    }
};

/// The corners of a box about the body, which leans as it does; corners i and i + 4 stand over each
/// other.
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
    const double most = max_range * (1 + kFarSlack);
    Box2 origin_box;
    for (std::size_t k = begin; k < end; k += is_one_ ? end - begin : 1)
        origin_box.add(origin(k).onFloor());
    middle_ = origin_box.center();
    spread_ =
        0.5 * std::sqrt(dot(origin_box.high - origin_box.low, origin_box.high - origin_box.low));
    box_ = origin_box;
    Vec2 ahead;
    for (std::size_t k = begin; k < end; ++k) {
        const double far =
            std::min(static_cast<double>(ranges_[k]) * (1 + kFarSlack) + kFarSlack, most);
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
        // Within some 84 degrees: upright rays point nowhere.
        if (!(dot(ahead, flat) > 0.1 * std::fabs(cross(ahead, flat)))) return;
        if (cross(right, flat) < 0) right = flat;
        if (cross(left, flat) > 0) left = flat;
    }
    right_ = 1 / std::sqrt(dot(right, right)) * right;
    left_ = 1 / std::sqrt(dot(left, left)) * left;
}

void BodyScan::meet(const MovingBody& body, const BodyExtent& extent) {
    const double radius = extent.whole * (1 + kFarSlack) + kFarSlack;
    const Vec2 there = body.pose.position - middle_;
    const double around = radius + spread_, far = around + reach_;
    if (body.bottom > high_ || body.top < low_ || cross(right_, there) < -around ||
        cross(left_, there) > around || dot(there, there) > far * far)
        return;
    for (std::size_t k = begin_; k < end_; ++k) {
        // Most rays pass by the circle about it, or end before.
        const Point3 from = origin(k);
        const Vec2 way = body.pose.position - from.onFloor();
        const Vec2 flat{directions_.x[k], directions_.y[k]};
        const double size = dot(flat, flat), aside = cross(way, flat);
        const double end = static_cast<double>(ranges_[k]) + radius;
        if (aside * aside > radius * radius * size + 1e-12 || dot(way, way) > end * end) continue;
        ranges_.shorten(k, BodyFrom(body, extent.axes, from).meet(directions_[k]), 1);
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
    const Vec2 corner{far_ * (1 + kFarSlack), far_ * (1 + kFarSlack)};
    return {middle - corner, middle + corner};
}

PixelBox BodyPicture::pixelsOf(const MovingBody& body, const BodyExtent& extent) const {
    const PixelBox all{0, 0, grid_.columns, grid_.rows};
    if (!is_plane_) return all;
    const Vec2 way = origin_.onFloor() - body.pose.position;
    const double near = 1e-6 + kFarSlack * extent.whole;
    if (length(way) <= extent.whole + near && origin_.z >= body.bottom - near &&
        origin_.z <= body.top + near)
        return all;

    std::array<Vec3, 8> corners = cornersOf(body, extent, origin_);
    double depth = 0;
    for (Vec3& corner : corners) {
        corner = projected(corner);
        depth = std::max(depth, corner.z);
    }
    // What lies before the picture's eye, cut off just in front of it.
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
    const BodyFrom from(body, extent.axes, origin_);
    for (int row = pixels.top; row < pixels.bottom; ++row) {
        for (int column = pixels.left; column < pixels.right; ++column) {
            const Vec3 ray = grid_.ray(column, row);
            const BodyMeeting met = from.meet(ray);
            if (met.multiple == std::numeric_limits<double>::infinity()) continue;
            const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.columns) +
                           static_cast<std::size_t>(column);
            ranges_.shorten(i, met, std::sqrt(dot(ray, ray)));
        }
    }
}

}  // namespace ispace
