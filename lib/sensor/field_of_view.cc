// SPDX-License-Identifier: GPL-3.0-or-later
#include "sensor/field_of_view.h"

#include <algorithm>
#include <cmath>

#include "sensor/camera.h"

namespace ispace {

FieldOfView FieldOfView::pyramid(const Pose3& pose, const Tangents& sides, double max_range,
                                 bool is_by_depth) {
    FieldOfView view;
    view.frame = Frame3(pose);
    view.max_range = max_range;
    view.is_by_depth = is_by_depth;
    view.sides = sides;
    return view;
}

FieldOfView FieldOfView::pyramid(const Pose3& pose, Angle half_x, Angle half_y, double max_range,
                                 bool is_by_depth) {
    const double across = tan(half_x), upright = tan(half_y);
    return pyramid(pose, {across, across, upright, upright}, max_range, is_by_depth);
}

FieldOfView FieldOfView::window(const Pose3& pose, Angle half_x, Angle half_y, double max_range) {
    return {Shape::Window,
            Frame3(pose),
            max_range,
            false,
            half_x,
            half_y,
            cos(std::min(half_x, Angle::degrees(180))),
            sin(std::min(half_y, Angle::degrees(90))),
            {},
            nullptr};
}

FieldOfView FieldOfView::cone(const Pose3& pose, Angle half, double max_range) {
    return {Shape::Cone,
            Frame3(pose),
            max_range,
            false,
            half,
            half,
            cos(std::min(half, Angle::degrees(180))),
            0,
            {},
            nullptr};
}

FieldOfView FieldOfView::picture(const Pose3& pose, const Camera& camera) {
    FieldOfView view;
    view.shape = Shape::Picture;
    view.frame = Frame3(pose);
    view.max_range = camera.max_range;
    view.is_by_depth = camera.lens == Lens::Pinhole;
    view.camera = std::make_shared<const Camera>(camera);
    return view;
}

bool FieldOfView::isInPicture(Vec3 local) const {
    const auto place = camera->project(local);
    return place && camera->holds(*place);
}

double FieldOfView::farthest() const {
    if (!is_by_depth) return max_range;
    if (shape == Shape::Picture) return max_range / cos(camera->widestInPicture());
    const double across = std::max(std::fabs(sides.left), std::fabs(sides.right));
    const double upright = std::max(std::fabs(sides.up), std::fabs(sides.down));
    return max_range * std::sqrt(1 + across * across + upright * upright);
}

}  // namespace ispace
