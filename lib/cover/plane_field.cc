// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/plane_field.h"

#include <algorithm>
#include <cmath>

namespace ispace {

FieldOfView::FieldOfView(const PlacedRanger& placed)
    : shape(placed.ranger.projection == Projection::Pinhole ? Shape::Pyramid : Shape::Window),
      frame(placed.pose),
      max_range(placed.ranger.max_range),
      is_by_depth(shape == Shape::Pyramid && placed.ranger.measures_depth),
      half_x(0.5 * placed.ranger.fov_x),
      half_y(0.5 * placed.ranger.fov_y) {
    across = shape == Shape::Pyramid ? tan(half_x) : cos(std::min(half_x, Angle::degrees(180)));
    upright = shape == Shape::Pyramid ? tan(half_y) : sin(std::min(half_y, Angle::degrees(90)));
}

FieldOfView::FieldOfView(const PlacedReceiver& placed)
    : shape(Shape::Cone),
      frame(placed.pose),
      max_range(placed.receiver.max_range),
      half_x(0.5 * placed.receiver.fov),
      half_y(half_x),
      across(cos(std::min(half_x, Angle::degrees(180)))) {}

double FieldOfView::farthest() const {
    return is_by_depth ? max_range * std::sqrt(1 + across * across + upright * upright) : max_range;
}

}  // namespace ispace
