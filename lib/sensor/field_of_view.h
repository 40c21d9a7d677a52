// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <memory>

#include "geom/pose.h"

namespace ispace {

struct Camera;

/// The rule of all range tests: compare as float32, end included. Distances kept as floats then
/// give the same answer for any shorter range.
inline bool withinRange(double distance, double max_range) {
    return static_cast<float>(distance) <= static_cast<float>(max_range);
}

/// Where the sides of a pyramid lie at depth 1, each counted outwards: left and right of the axis,
/// above and below it. One may be negative, if less than the opposite one is positive.
struct Tangents {
    double left = 0, right = 0, up = 0, down = 0;
};

/// What a sensor with an axis sees if nothing is in the way. Its edges belong to it, with a margin
/// for rounding.
struct FieldOfView {
    enum class Shape {
        Pyramid,  ///< of a pinhole, through the edges of its picture
        Window,   ///< an interval of bearings and one of elevations
        Cone,     ///< about the axis
        Picture,  ///< what a camera with a bending lens has in its picture
    };
    Shape shape = Shape::Pyramid;
    Frame3 frame;
    double max_range = 0;
    bool is_by_depth = false;  ///< the range is measured along the axis
    /// Of windows and cones half of the fields of view; of a cone both the same.
    Angle half_x, half_y;
    /// Of the window the cosine of half_x and the sine of half_y; of the cone its cosine, once.
    double across = 0, upright = 0;
    Tangents sides;                        ///< of a pyramid
    std::shared_ptr<const Camera> camera;  ///< of a picture

    /// \pre the sides are not empty: left + right > 0, up + down > 0
    static FieldOfView pyramid(const Pose3& pose, const Tangents& sides, double max_range,
                               bool is_by_depth);
    /// Half the fields of view across and upright, less than 90 degrees each.
    static FieldOfView pyramid(const Pose3& pose, Angle half_x, Angle half_y, double max_range,
                               bool is_by_depth);
    static FieldOfView window(const Pose3& pose, Angle half_x, Angle half_y, double max_range);
    /// `half`: between the axis and the edge.
    static FieldOfView cone(const Pose3& pose, Angle half, double max_range);
    /// By the camera's range: of pinholes along the axis.
    static FieldOfView picture(const Pose3& pose, const Camera& camera);

    /// True if a place is in view and in range.
    [[nodiscard]] bool holds(Point3 place) const;
    /// True if the direction to a place (in its frame) is in view; the sensor's own place is.
    [[nodiscard]] bool points(Vec3 local) const;
    /// No place in view is farther.
    [[nodiscard]] double farthest() const;

  private:
    [[nodiscard]] bool isInPicture(Vec3 local) const;
};

inline bool FieldOfView::points(Vec3 local) const {
    constexpr double kRounding = 1e-12;
    const double plan = local.x * local.x + local.y * local.y;
    const double distance = std::sqrt(plan + local.z * local.z), slack = kRounding * distance;
    switch (shape) {
        case Shape::Pyramid:
            return local.y <= sides.left * local.x + slack &&
                   -local.y <= sides.right * local.x + slack &&
                   local.z <= sides.up * local.x + slack &&
                   -local.z <= sides.down * local.x + slack;
        case Shape::Window:
            return local.x >= across * std::sqrt(plan) - slack &&
                   std::fabs(local.z) <= upright * distance + slack;
        case Shape::Cone:
            return local.x >= across * distance - slack;
        case Shape::Picture:
            return isInPicture(local);
    }
    return false;
}

inline bool FieldOfView::holds(Point3 place) const {
    const Vec3 local = frame.toLocal(place);
    const double range = is_by_depth ? local.x : std::sqrt(dot(local, local));
    return withinRange(range, max_range) && points(local);
}

}  // namespace ispace
