// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "cover/range_rule.h"
#include "geom/pose.h"
#include "layout/ranger.h"
#include "layout/ultrasound.h"

namespace ispace {

/// All that a ranger or a receiver would see if nothing stood in its way. Its edges are in it,
/// whatever rounding makes of them.
struct FieldOfView {
    enum class Shape {
        Pyramid,  ///< of a pinhole, through the edges of its picture
        Window,   ///< of bearings and elevations
        Cone,     ///< about the axis
    };
    Shape shape = Shape::Pyramid;
    Frame3 frame;
    double max_range = 0;
    bool is_by_depth = false;  ///< the range is that along the axis
    Angle half_x, half_y;      ///< half of the fields of view; of a cone both the same
    /// Of the pyramid tangents of the halves; of the window the cosine of half_x and the sine of
    /// half_y; of the cone its cosine, once.
    double across = 0, upright = 0;

    explicit FieldOfView(const PlacedRanger& placed);
    explicit FieldOfView(const PlacedReceiver& placed);

    /// True if a place is in view and in range.
    [[nodiscard]] bool holds(Point3 place) const;
    /// True if the direction to a place is in view; the sensor's own place is.
    [[nodiscard]] bool points(Vec3 local) const;
    /// Greatest distance of what is in view.
    [[nodiscard]] double farthest() const;
};

inline bool FieldOfView::points(Vec3 local) const {
    constexpr double kRounding = 1e-12;
    const double plan = local.x * local.x + local.y * local.y;
    const double distance = std::sqrt(plan + local.z * local.z), slack = kRounding * distance;
    switch (shape) {
        case Shape::Pyramid:
            return std::fabs(local.y) <= across * local.x + slack &&
                   std::fabs(local.z) <= upright * local.x + slack;
        case Shape::Window:
            return local.x >= across * std::sqrt(plan) - slack &&
                   std::fabs(local.z) <= upright * distance + slack;
        case Shape::Cone:
            return local.x >= across * distance - slack;
    }
    return false;
}

inline bool FieldOfView::holds(Point3 place) const {
    const Vec3 local = frame.toLocal(place);
    const double range = is_by_depth ? local.x : std::sqrt(dot(local, local));
    return withinRange(range, max_range) && points(local);
}

}  // namespace ispace
