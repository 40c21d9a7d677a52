// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/pose.h"

namespace ispace {

Point2 Pose2::operator*(Point2 local) const { return position + *this * Vec2{local.x, local.y}; }

Vec2 Pose2::operator*(Vec2 local) const {
    const double c = cos(heading), s = sin(heading);
    return {c * local.x - s * local.y, s * local.x + c * local.y};
}

Vec3 Pose3::beam(Angle bearing) const {
    const double cb = cos(bearing), sb = sin(bearing);
    const double ct = cos(tilt), st = sin(tilt), cr = cos(roll), sr = sin(roll);
    const double ch = cos(heading), sh = sin(heading);
    // Rx(roll), then Ry(-tilt), then Rz(heading), applied to (cb, sb, 0).
    const Vec3 rolled{cb, cr * sb, sr * sb};
    const Vec3 tilted{ct * rolled.x - st * rolled.z, rolled.y, st * rolled.x + ct * rolled.z};
    return {ch * tilted.x - sh * tilted.y, sh * tilted.x + ch * tilted.y, tilted.z};
}

}  // namespace ispace
