// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of coverage in planes: sensors at a pose.
#pragma once

#include "geom/pose.h"
#include "scene/sensor/sensor.h"

namespace ispace {

inline Pose3 poseAt(Point3 place, double heading, double tilt, double roll = 0) {
    return {place, Angle::degrees(heading), Angle::degrees(tilt), Angle::degrees(roll)};
}

inline Sensor rangerAt(const Pose3& pose, double fov_x, double fov_y, double range,
                       Projection projection = Projection::Pinhole) {
    Ranger ranger;
    ranger.projection = projection;
    ranger.fov_x = Angle::degrees(fov_x);
    ranger.fov_y = Angle::degrees(fov_y);
    ranger.max_range = range;
    return {"r", ranger, pose};
}

inline Sensor receiverAt(const Pose3& pose, double fov, double range) {
    Receiver receiver;
    receiver.fov = Angle::degrees(fov);
    receiver.max_range = range;
    return {"u", receiver, pose};
}

/// Creates a laser with beams a degree apart.
inline Laser laserWith(double range, double first, double span) {
    Laser laser;
    laser.max_range = range;
    laser.first = Angle::degrees(first);
    laser.beams = static_cast<int>(span) + 1;
    return laser;
}

inline double tanOf(double degrees) { return tan(Angle::degrees(degrees)); }

}  // namespace ispace
