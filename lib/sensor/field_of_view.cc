// SPDX-License-Identifier: GPL-3.0-or-later
#include "sensor/field_of_view.h"

#include <algorithm>
#include <cmath>

namespace ispace {

FieldOfView FieldOfView::pyramid(const Pose3& pose, Angle half_x, Angle half_y, double max_range,
                                 bool is_by_depth) {
    return {Shape::Pyramid, Frame3(pose), max_range,   is_by_depth,
            half_x,         half_y,       tan(half_x), tan(half_y)};
}

FieldOfView FieldOfView::window(const Pose3& pose, Angle half_x, Angle half_y, double max_range) {
    return {Shape::Window,
            Frame3(pose),
            max_range,
            false,
            half_x,
            half_y,
            cos(std::min(half_x, Angle::degrees(180))),
            sin(std::min(half_y, Angle::degrees(90)))};
}

FieldOfView FieldOfView::cone(const Pose3& pose, Angle half, double max_range) {
    return {Shape::Cone,
            Frame3(pose),
            max_range,
            false,
            half,
            half,
            cos(std::min(half, Angle::degrees(180)))};
}

double FieldOfView::farthest() const {
    return is_by_depth ? max_range * std::sqrt(1 + across * across + upright * upright) : max_range;
}

}  // namespace ispace
