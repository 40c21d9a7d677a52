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

Box2 BodyScan::box() const {
    const Point2 middle = origin_.onFloor();
    const Vec2 corner{far_ * (1 + kFarSlack), far_ * (1 + kFarSlack)};
    return {middle - corner, middle + corner};
}

/// Those rays that pass its middle on the floor near enough.
void BodyScan::meet(const MovingBody& body, const BodyExtent& extent) {
    const Vec2 way = body.pose.position - origin_.onFloor();
    const double nearest = std::sqrt(dot(way, way)) - extent.whole;
    if (!(nearest <= far_ * (1 + kFarSlack))) return;
    const BodyFrom from(body, extent.axes, origin_);
    const double wide = extent.whole * (1 + kFarSlack) * extent.whole * (1 + kFarSlack);
    for (std::size_t k = 0; k < directions_.size(); ++k) {
        const double x = directions_.x[k], y = directions_.y[k];
        const double aside = way.x * y - way.y * x;
        if (aside * aside <= wide * (x * x + y * y) + 1e-12 &&
            static_cast<double>(ranges_[k]) > nearest)
            ranges_.shorten(k, from.meet(directions_[k]), 1);
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
