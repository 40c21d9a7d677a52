// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geom/point.h"

namespace ispace {

/// Position and heading of a frame on the floor; the frame's x axis faces along the heading.
/// Written world_from_body: it takes points of the body frame to the world frame.
struct Pose2 {
    Point2 position;
    Angle heading;

    /// A point of this frame in the outer frame.
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

}  // namespace ispace
