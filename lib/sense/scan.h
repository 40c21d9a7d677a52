// SPDX-License-Identifier: GPL-3.0-or-later
// lib/sense: sensors and the formats of their readings. Uses trace and below; TBB inside.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sensor/sensor.h"
#include "trace/moving_bodies.h"
#include "trace/worlds.h"

namespace ispace {

/// One scan of a laser range finder. `ranges[k]` belongs to the beam of bearing
/// `laser.bearing(k)`: metres from the optical centre; +infinity means no return, which is
/// nothing within max_range or a surface nearer than min_range.
struct Scan {
    double time = 0;  ///< seconds, of the first beam
    int frame = 0;
    int number = 0;  ///< of the scan within a sweep
    Pose3 pose;      ///< of the sensor, at the first beam
    /// Where it was at each beam, if it moved meanwhile; else empty.
    std::vector<Pose3> beam_poses;
    std::vector<float> ranges;

    [[nodiscard]] const Pose3& poseAt(std::size_t beam) const {
        return beam_poses.empty() ? pose : beam_poses[beam];
    }
};

/// Where the beams of one sensor point, kept from scan to scan: cosines are computed once.
///
/// Degrees add up exactly where their cosines do not: a level beam at 45 degrees of a sensor that
/// faces 45 degrees runs along y. A sensor that moves (`turns`) faces anywhere, and its beams are
/// turned as a whole, which is faster.
class Beams {
  public:
    Beams(const Laser& laser, bool turns);
    /// Unit vectors of all beams in the world frame, of the sensor at this pose; valid until the
    /// next call.
    const Directions& at(const Pose3& pose);
    /// Unit vector of a beam in the sensor's frame.
    [[nodiscard]] Vec2 local(std::size_t beam) const { return {local_.x[beam], local_.y[beam]}; }

  private:
    void point(const Pose3& pose);

    Angle first_, step_;
    bool turns_;
    Directions local_;  // in the sensor's frame, z is 0
    Directions directions_;
    bool known_ = false;  // directions_ are those of:
    Angle heading_, tilt_, roll_;
};

/// What a reading may have besides the device's ideal.
struct ReadingOptions {
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
};

/// Reads one laser again and again: keeps what can be computed once, and its memory. Not
/// thread-safe: one a thread, or one a sensor. Its results do not depend on what it read before.
class LaserCaster {
  public:
    /// `turns`: as Beams has it. \pre all outlive it
    LaserCaster(const Worlds& worlds, const MovingBodies& bodies, const Sensor& sensor, bool turns,
                const ReadingOptions& options);
    /// Sets the ranges of a scan whose frame, number, pose and beam_poses are given: what the
    /// device reads there, the blind zone and, if wanted, its noise applied. \pre the pose is
    /// prepared in the worlds, and their mesh if beam_poses are not all level and at its height
    void cast(Scan& scan);

  private:
    void castFrom(const Pose3& pose, std::span<float> ranges);
    void castApart(Scan& scan);

    const Worlds* worlds_;
    const MovingBodies* bodies_;
    const Sensor* sensor_;
    ReadingOptions options_;
    std::uint64_t id_hash_;
    std::uint32_t own_;
    Beams beams_;
    Directions apart_;
    std::vector<Point3> origins_;
    std::vector<float> cosines_, errors_;
};

/// Distance to the first surface of every beam up to max_range, whatever min_range is; +infinity
/// if there is none. What figures are computed from.
std::vector<float> castBeams(const RayWorld& world, const Sensor& sensor);

/// Eq. (4.4) of the thesis over all beams: sum of step * pi * dist^2 / 360 with no return counted
/// as max_range. `ranges` as of castBeams.
double sliceArea(const Laser& laser, std::span<const float> ranges);

}  // namespace ispace
