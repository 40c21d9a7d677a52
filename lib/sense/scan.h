// SPDX-License-Identifier: GPL-3.0-or-later
// lib/sense: sensors and the formats of their readings. Uses render and below; TBB inside.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sensor/sensor.h"
#include "trace/moving_bodies.h"
#include "trace/worlds.h"

namespace ispace {

/// One scan of a laser range finder. `ranges[k]` belongs to the beam with bearing
/// `laser.bearing(k)`, in metres from the optical centre. +infinity is no return: nothing within
/// max_range, or a surface nearer than min_range.
struct Scan {
    double time = 0;  ///< seconds, of the first beam
    int frame = 0;
    int number = 0;  ///< of the scan within a sweep
    Pose3 pose;      ///< of the sensor, at the first beam
    /// Its pose at each beam if it moved during the scan; else empty.
    std::vector<Pose3> beam_poses;
    std::vector<float> ranges;

    [[nodiscard]] const Pose3& poseAt(std::size_t beam) const {
        return beam_poses.empty() ? pose : beam_poses[beam];
    }
};

/// Directions of the beams of one sensor, kept from scan to scan.
///
/// Sums of degrees are exact where products of cosines are not: a level beam at 45 degrees of a
/// sensor that faces 45 degrees runs exactly along y. The beams of a sensor that moves (`turns`)
/// are rotated as a whole instead, which is faster.
class Beams {
  public:
    Beams(const Laser& laser, bool turns);
    /// Unit vectors of all beams in the world frame; valid until the next call.
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

/// How readings differ from ideal ones.
struct ReadingOptions {
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
};

/// Beams from `begin` to before `end`, and the bodies that stand in their way.
struct BeamsAmong {
    std::size_t begin = 0, end = 0;
    const MovingBodies* bodies = nullptr;
};

/// Takes scans of one laser, keeping its memory and what can be computed once. Not thread-safe: use
/// one per thread or per sensor. Results do not depend on earlier scans.
class LaserCaster {
  public:
    /// `turns`: see Beams. \pre all arguments outlive it
    LaserCaster(const Worlds& worlds, const MovingBodies& bodies, const Sensor& sensor, bool turns,
                const ReadingOptions& options);
    /// Sets the ranges of a scan from its frame, number, pose and beam_poses, including the blind
    /// zone and, if wanted, noise. \pre the worlds are prepared for the pose, and their mesh if
    /// beam_poses are not all level and at its height
    void cast(Scan& scan);
    /// The same while bodies move. \pre `parts` hold each beam once
    void cast(Scan& scan, std::span<const BeamsAmong> parts);

  private:
    void castFrom(const Pose3& pose, std::span<float> ranges, std::span<const BeamsAmong> parts);
    void castApart(Scan& scan, std::span<const BeamsAmong> parts);
    const Directions& partOf(const Directions& all, const BeamsAmong& part);

    const Worlds* worlds_;
    const MovingBodies* bodies_;
    const Sensor* sensor_;
    ReadingOptions options_;
    std::uint64_t id_hash_;
    std::uint32_t own_;
    Beams beams_;
    Directions apart_, part_;
    std::vector<Point3> origins_;
    std::vector<float> cosines_, errors_;
};

/// Distance to the first surface of every beam up to max_range, whatever min_range is; +infinity
/// if there is none. Metrics are computed from these.
std::vector<float> castBeams(const RayWorld& world, const Sensor& sensor);

/// Eq. (4.4) of the thesis: the sum of step * pi * dist^2 / 360 over all beams, where no return
/// counts as max_range. \pre ranges are those of castBeams
double sliceArea(const Laser& laser, std::span<const float> ranges);

}  // namespace ispace
