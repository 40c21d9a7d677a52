// SPDX-License-Identifier: GPL-3.0-or-later
// What the writers of OBJ and STL share.
#pragma once

#include <array>
#include <cmath>

#include "geom/pose.h"
#include "io/model.h"

namespace ispace {

/// Takes places of a node's meshes to the world.
class NodeFrame {
  public:
    explicit NodeFrame(const ModelNode& node) : placed_(node.pose.has_value()) {
        if (!placed_) return;
        origin_ = node.pose->position;
        x_ = node.pose->beam(Angle());
        y_ = node.pose->beam(Angle::degrees(90));
        z_ = cross(x_, y_);
    }

    Point3 operator*(Point3 p) const {
        return placed_ ? origin_ + p.x * x_ + p.y * y_ + p.z * z_ : p;
    }

  private:
    bool placed_;
    Point3 origin_;
    Vec3 x_, y_, z_;
};

/// Unit normal of the face, counter-clockwise seen from its tip; the null vector if the corners
/// lie on a line as far as doubles tell.
inline Vec3 faceNormal(const std::array<Point3, 3>& corners) {
    const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double size = length(normal);
    return size > 0 && std::isfinite(size) ? 1 / size * normal : Vec3();
}

}  // namespace ispace
