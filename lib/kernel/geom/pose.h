// SPDX-License-Identifier: GPL-3.0-or-later
// Poses in the plane and in space, and their transforms.
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
    [[nodiscard]] Vec2 operator*(Vec2 local) const;
    friend bool operator==(const Pose2&, const Pose2&) = default;
};

/// Pose of a sensor in space: Rz(heading) Ry(-tilt) Rx(roll), then moved to `position`.
/// Heading 0 faces +x; positive tilt looks up; positive roll turns the left side up.
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
    explicit Frame3(const Pose3& pose);
    /// Maps a vector of this frame to the outer frame.
    [[nodiscard]] Vec3 operator*(Vec3 local) const {
        return {local.x * forward.x + local.y * left.x + local.z * up.x,
                local.x * forward.y + local.y * left.y + local.z * up.y,
                local.x * forward.z + local.y * left.z + local.z * up.z};
    }
    /// Maps a point of the outer frame to this frame.
    [[nodiscard]] Vec3 toLocal(Point3 outer) const {
        const Vec3 way = outer - origin;
        return {dot(way, forward), dot(way, left), dot(way, up)};
    }
};

}  // namespace ispace
