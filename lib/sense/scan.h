// SPDX-License-Identifier: GPL-3.0-or-later
// lib/sense: sensors and the formats of their readings. Uses trace and below; TBB inside.
#pragma once

#include <span>
#include <vector>

#include "layout/laser.h"
#include "layout/robot.h"
#include "trace/moving_bodies.h"
#include "trace/worlds.h"

namespace ispace {

/// One sweep of a laser range finder. `ranges[k]` belongs to the beam of bearing
/// `laser.bearing(k)`: metres from the optical centre; +infinity means no return, which is
/// nothing within max_range or a surface nearer than min_range.
struct Scan {
    double time = 0;  ///< seconds
    int frame = 0;
    std::vector<float> ranges;
};

/// Where the beams of one sensor point, kept from scan to scan: the cosines are computed once.
///
/// Degrees add up exactly where their cosines do not: a level beam at 45 degrees of a sensor that
/// faces 45 degrees runs along y. A sensor that rides on a robot faces anywhere, and turns its
/// beams.
class Beams {
  public:
    explicit Beams(const PlacedLaser& sensor);
    /// Unit vectors of all beams in the world frame, of the sensor at this pose; valid until the
    /// next call. \pre the pose is level if and only if that of the constructor's sensor was
    std::span<const Vec3> at(const Pose3& pose);

  private:
    [[nodiscard]] bool isSum(const Pose3& pose) const { return pose.isLevel() && !rides_; }
    void point(const Pose3& pose);

    Angle first_, step_;
    bool rides_;
    std::vector<Vec2> local_;  // unit vectors in the sensor's frame, where they are turned
    std::vector<Vec3> directions_;
    bool known_ = false;  // directions_ are those of:
    Angle heading_, tilt_, roll_;
};

/// Distance to the first surface of every beam up to max_range, whatever min_range is; +infinity
/// if there is none. What figures are computed from.
std::vector<float> castBeams(const RayWorld& world, const PlacedLaser& sensor);

/// What the sensor reads: castBeams with the blind zone applied.
Scan castScan(const RayWorld& world, const PlacedLaser& sensor);

/// The same with bodies in the way; those of the robot that carries the sensor are not.
/// \pre the beams are those of the sensor
Scan castScan(const RayWorld& world, const PlacedLaser& sensor, Beams& beams,
              const MovingBodies& bodies);

/// One scan of each sensor, in order, shared out over all cores.
std::vector<Scan> castScans(Worlds& worlds, std::span<const PlacedLaser> sensors,
                            const MovingBodies& bodies = {});

/// The bodies of robots at their poses; each is owned by the index of its robot.
std::vector<MovingBody> robotBodies(std::span<const PlacedRobot> robots);
MovingBody robotBody(const RobotModel& model, const Pose2& pose, std::uint32_t owner);

/// Eq. (4.4) of the thesis over all beams: sum of step * pi * dist^2 / 360 with no return counted
/// as max_range. `ranges` as of castBeams.
double sliceArea(const Laser& laser, std::span<const float> ranges);

}  // namespace ispace
