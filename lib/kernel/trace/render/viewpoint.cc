// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/viewpoint.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>

namespace ispace {

namespace {

/// Depths count along the axis where there is a picture plane.
Vec3 byDepth(const Camera& camera, Vec3 ray) {
    return camera.lens == Lens::Pinhole ? (1 / ray.x) * ray : ray;
}

std::vector<Vec3> rayCount(const Camera& camera) {
    std::vector<Vec3> rays(camera.pixels());
    tbb::parallel_for(0, camera.rows, [&](int row) {
        for (int column = 0; column < camera.columns; ++column) {
            const auto ray = camera.ray({1.0 * column, 1.0 * row});
            if (!ray) continue;
            const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.columns);
            rays[i + static_cast<std::size_t>(column)] = byDepth(camera, *ray);
        }
    });
    return rays;
}

}  // namespace

CameraView::CameraView(const Camera& camera, const Pose3& pose)
    : Viewpoint(camera.columns, camera.rows), camera_(camera), world_from_camera_(pose) {
    if (!camera.isStraight()) rays_ = std::make_shared<const std::vector<Vec3>>(rayCount(camera));
}

CameraView CameraView::at(const Pose3& pose) const {
    CameraView moved = *this;
    moved.world_from_camera_ = Frame3(pose);
    return moved;
}

std::optional<Vec3> CameraView::localRay(PixelPoint place) const {
    const double column = std::round(place.column), row = std::round(place.row);
    const bool is_kept = rays_ != nullptr && column == place.column && row == place.row &&
                         column >= 0 && column < columns() && row >= 0 && row < rows();
    if (is_kept) {
        const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns());
        const Vec3 ray = (*rays_)[i + static_cast<std::size_t>(column)];
        return ray == Vec3() ? std::nullopt : std::optional(ray);
    }
    const auto ray = camera_.ray(place);
    return ray ? std::optional(byDepth(camera_, *ray)) : std::nullopt;
}

std::optional<PixelRay> CameraView::sightLine(PixelPoint place) const {
    const auto ray = localRay(place);
    if (!ray) return std::nullopt;
    return PixelRay{world_from_camera_.origin, world_from_camera_ * *ray};
}

std::optional<EvenPixelRays> CameraView::evenPixelRays() const {
    if (!camera_.isStraight()) return std::nullopt;
    const Camera& c = camera_;
    return EvenPixelRays{.origin = world_from_camera_.origin,
                         .origin_right = {},
                         .origin_down = {},
                         .direction = world_from_camera_ * Vec3{1, c.cx / c.fx, c.cy / c.fy},
                         .right = world_from_camera_ * Vec3{0, -1 / c.fx, 0},
                         .down = world_from_camera_ * Vec3{0, 0, -1 / c.fy}};
}

std::optional<PixelPoint> CameraView::project(Point3 place) const {
    return camera_.project(world_from_camera_.toLocal(place));
}

OrthographicView::OrthographicView(const Pose3& pose, double width, int columns, int rows)
    : Viewpoint(columns, rows), frame_(pose), pixel_(width / columns) {
    const Vec3 right = -pixel_ * frame_.left, down = -pixel_ * frame_.up;
    const Point3 corner = frame_.origin + -(columns - 1) / 2.0 * right + -(rows - 1) / 2.0 * down;
    lines_ = {corner, right, down, frame_.forward, {}, {}};
}

std::optional<PixelRay> OrthographicView::sightLine(PixelPoint place) const {
    return lines_.at(place);
}

PixelPoint OrthographicView::project(Point3 place) const {
    const Vec3 local = frame_.toLocal(place);
    return {(columns() - 1) / 2.0 - local.y / pixel_, (rows() - 1) / 2.0 - local.z / pixel_};
}

}  // namespace ispace
