// SPDX-License-Identifier: GPL-3.0-or-later
// Poses in the plane and in space, and their transforms.
//
// A pose is named outer_from_inner: it maps coordinates of the inner frame to the outer frame, and
// neighbours cancel in products. Frames: x forward, y left, z up. Tilt is positive upwards, against
// the sign of a rotation about y; roll is positive if the left side rises.
//
//     const Pose2 world_from_robot{{2, 1}, Angle::degrees(90)};
//     const Point2 bumper = world_from_robot * Point2{0.3, 0};  // (2, 1.3), exactly
//
// Values without invariants, pure functions. A product costs a cosine and a sine; Frame3 computes
// them once for many points. Rotations of multiples of 90 degrees are exact.
#pragma once

#include "geom/point.h"

namespace ispace {

/// Position and heading of a frame on the floor; the frame's x axis faces along the heading. Named
/// world_from_body: it maps points of the body frame to the world frame.
struct Pose2 {
    Point2 position;
    Angle heading;

    /// Maps a point of this frame to the outer frame.
    [[nodiscard]] Point2 operator*(Point2 local) const;
    /// Maps a vector: turns it, without moving it.
    [[nodiscard]] Vec2 operator*(Vec2 local) const;
    friend bool operator==(const Pose2&, const Pose2&) = default;
};

/// Pose of a sensor in space: Rz(heading) Ry(-tilt) Rx(roll), then moved to `position`.
/// Heading 0 faces +x; positive tilt looks up; positive roll turns the left side up. Several
/// triples of angles give one rotation at tilts of ±90 degrees; comparison is by the angles.
struct Pose3 {
    Point3 position;
    Angle heading, tilt, roll;

    /// Level: beams of a planar sensor stay at the height of `position`.
    [[nodiscard]] bool isLevel() const { return tilt == Angle() && roll == Angle(); }
    /// Unit vector of the beam with this bearing in the sensor's x-y plane; without roll
    /// Rz(h) (cos b cos t, sin b, cos b sin t), the thesis' eq. 3.3-3.6 in our axes.
    [[nodiscard]] Vec3 beam(Angle bearing) const;
    friend bool operator==(const Pose3&, const Pose3&) = default;
};

/// A frame given by its axes in the outer frame; faster than Pose3 for many points. Exact if angles
/// are multiples of 90 degrees.
struct Frame3 {
    Point3 origin;
    Vec3 forward{1, 0, 0}, left{0, 1, 0}, up{0, 0, 1};

    Frame3() = default;
    /// Three cosines and sines. The axes are orthonormal up to rounding.
    explicit Frame3(const Pose3& pose);
    /// Maps a vector of this frame to the outer frame.
    [[nodiscard]] Vec3 operator*(Vec3 local) const {
        return {local.x * forward.x + local.y * left.x + local.z * up.x,
                local.x * forward.y + local.y * left.y + local.z * up.y,
                local.x * forward.z + local.y * left.z + local.z * up.z};
    }
    /// Maps a point of the outer frame to this frame: the inverse, by the transposed axes, so a
    /// point there and back moves by some ulp.
    [[nodiscard]] Vec3 toLocal(Point3 outer) const {
        const Vec3 way = outer - origin;
        return {dot(way, forward), dot(way, left), dot(way, up)};
    }
};

}  // namespace ispace
