// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/sense: sensors and the formats of their readings. Uses trace, drawing; TBB inside.
//
// Scans of planar lasers. A beam ends at the first surface or moving body, whichever is nearer, as
// exactly as RayWorld and MovingBodies say; ranges are float32 metres. Noise is drawn by seed, id
// and frame, so that a scan depends on pose, time and key alone, on any number of threads.
//
//     RayScenes worlds(scene.environment);
//     worlds.prepare(laser.pose);
//     LaserCaster caster(worlds, bodies, laser, false, {.noise_seed = 1});
//     Scan scan{.frame = 7, .pose = laser.pose};
//     caster.cast(scan);  // O(beams) rays
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "geom/pose.h"
#include "scene/sensor/sensor.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

struct ReadingKind;

/// True for a laser that scans only the slice at its height: level, and turning about the vertical
/// if it sweeps.
bool scansSlice(const Laser& laser, const Pose3& pose);
bool scansSlice(const Sensor& sensor);

/// Bearings between the first and the last beam of a laser, ends included.
struct BearingWindow {
    Vec2 middle;    ///< unit vector
    double cosine;  ///< of half the window, -1 if it spans a full turn
    explicit BearingWindow(const Laser& laser, Angle more = {});
    /// True if a point of the scan plane, in the sensor's frame, lies in the window; the origin
    /// does.
    [[nodiscard]] bool holds(Vec3 local) const;
};

/// A scan plane that is not level, as a height above the floor.
class ScanPlane {
  public:
    explicit ScanPlane(const Pose3& pose)
        : frame_(pose), up_(frame_.forward.x * frame_.left.y - frame_.forward.y * frame_.left.x) {}

    [[nodiscard]] const Frame3& frame() const { return frame_; }
    /// Vertical component of the normal; 0 if the plane is upright.
    [[nodiscard]] double up() const { return up_; }
    /// Returns the height of the plane above a point of the floor. \pre up() is not 0
    [[nodiscard]] double heightAt(Point2 p) const {
        const Vec3 &f = frame_.forward, &l = frame_.left;
        const double nx = f.y * l.z - f.z * l.y, ny = f.z * l.x - f.x * l.z;
        return frame_.origin.z -
               (nx * (p.x - frame_.origin.x) + ny * (p.y - frame_.origin.y)) / up_;
    }

  private:
    Frame3 frame_;
    double up_;
};

/// The points that the scans of a laser cross, ignoring obstacles, while the laser changes one
/// angle of its pose continuously. A point lies in the scan plane at two angles at most, the roots
/// of a cos s + b sin s + c = 0, or at all of them: a closed form, O(1). Edges of the window and of
/// the sweep count, within kUnitTolerance. Const members are thread-safe.
class SweptScan {
  public:
    /// Prepares the sweep. \pre placed.as<Laser>().sweep is not None
    explicit SweptScan(const Sensor& placed);

    /// True if a scan of the sweep has the point between its first and last beam.
    [[nodiscard]] bool passes(Point3 place) const;

  private:
    struct Turns {
        CosSin heading, tilt, roll;
        [[nodiscard]] Vec3 toSensor(Vec3 way) const;
    };
    /// Returns (x, y, z) such that the point lies in the scan plane if x cos s + y sin s + z = 0
    /// for the swept angle s.
    [[nodiscard]] Vec3 equationOf(Vec3 way) const;
    [[nodiscard]] bool isSeenAt(CosSin swept, Vec3 way) const;
    [[nodiscard]] CosSin& sweptOf(Turns& turns) const;

    SweepAxis axis_;
    Point3 origin_;
    Turns turns_;           // at the start
    CosSin middle_;         // of the swept angle
    double cosine_;         // of half the sweep, -1 if it is a full turn
    BearingWindow window_;  // of one scan
    BearingWindow wide_;    // of all scans, if the scan plane turns in itself
};

/// One scan of a laser range finder. `ranges[k]` belongs to the beam with bearing
/// `laser.bearing(k)`, in metres from the optical centre. +infinity is no return: no surface within
/// max_range, or one nearer than min_range.
struct Scan {
    double time = 0;  ///< seconds, of the first beam
    int frame = 0;
    int number = 0;  ///< index of the scan in a sweep
    Pose3 pose;      ///< of the sensor, at the first beam
    /// Pose of the sensor at each beam if it moved during the scan; else empty.
    std::vector<Pose3> beam_poses;
    std::vector<float> ranges;

    [[nodiscard]] const Pose3& poseAt(std::size_t beam) const {
        return beam_poses.empty() ? pose : beam_poses[beam];
    }
    static const ReadingKind kKind;
};

/// Unit vectors of lasers' beams in the lasers' frames, shared by all lasers with equal beams:
/// separate copies for thousands of lasers would not fit the processor's cache. Not thread-safe.
class LocalBeams {
  public:
    /// Returns the vectors of a laser's beams; z is 0.
    std::shared_ptr<const Directions> of(const Laser& laser);

  private:
    std::map<std::tuple<Angle, Angle, int>, std::shared_ptr<const Directions>> known_;
};

/// Computes directions of a sensor's beams; caches those of a static sensor.
///
/// Sums of degrees are exact, products of cosines are not: a level beam at 45 degrees of a sensor
/// with heading 45 degrees runs exactly along y. The beams of a moving sensor (`turns`) are rotated
/// as a whole instead, which is faster.
class Beams {
  public:
    /// Prepares the beams. \param local beams of this laser, if it shares them
    Beams(const Laser& laser, bool turns, std::shared_ptr<const Directions> local = nullptr);
    /// Returns unit vectors of all beams in the world frame; valid until this thread's next call
    /// for any sensor.
    const Directions& at(const Pose3& pose);
    /// Returns unit vectors in the sensor's frame.
    [[nodiscard]] const Directions& local() const { return *local_; }

  private:
    void turn(const Pose3& pose, Directions& directions) const;
    void point(const Pose3& pose);

    Angle first_, step_;
    bool turns_;
    std::shared_ptr<const Directions> local_;
    Directions directions_;  // of a static sensor
    bool known_ = false;     // directions_ were computed for:
    Angle heading_, tilt_, roll_;
};

/// Deviations from ideal readings.
struct ReadingOptions {
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
};

/// Beams from `begin` to before `end`, and the bodies that may block them.
struct BeamsAmong {
    std::size_t begin = 0, end = 0;
    const MovingBodies* bodies = nullptr;
};

/// Origins of the beams of a level laser that moves during the scan, one array per component, and
/// unit vectors along the laser's heading at each beam.
struct BeamFrames {
    std::vector<double> x, y, cos, sin;

    void resize(std::size_t count) {
        for (auto* const values : {&x, &y, &cos, &sin}) values->resize(count);
    }
};

/// Takes scans of one laser and reuses its memory and precomputed values. Not thread-safe: use one
/// per thread or per sensor. Results do not depend on earlier scans.
class LaserCaster {
  public:
    /// `turns`, `local`: see Beams. \pre the references outlive it
    LaserCaster(const RayScenes& worlds, const MovingBodies& bodies, const Sensor& sensor,
                bool turns, const ReadingOptions& options,
                std::shared_ptr<const Directions> local = nullptr);
    /// Computes the ranges of a scan from its frame, number, pose and beam_poses, including the
    /// blind zone and, if requested, noise. \pre the worlds are prepared for the pose, and their
    /// mesh if beam_poses are not all level and at its height
    void cast(Scan& scan);
    /// Likewise, with moving bodies. \pre `parts` hold each beam once
    void cast(Scan& scan, std::span<const BeamsAmong> parts);
    /// Likewise, for a laser that stays level at its height; replaces beam_poses.
    /// \pre `frames` has an element for each beam
    void cast(Scan& scan, const BeamFrames& frames, std::span<const BeamsAmong> parts);

  private:
    template <typename Cast>
    void castWith(Scan& scan, Cast cast);
    void castFrom(const Pose3& pose, std::span<float> ranges, std::span<const BeamsAmong> parts);
    void castApart(Scan& scan, std::span<const BeamsAmong> parts);
    void castLevel(Scan& scan, const BeamFrames& frames, std::span<const BeamsAmong> parts);
    struct RaysApart;
    void castRays(const RayWorld& world, const RaysApart& rays, Scan& scan,
                  std::span<const BeamsAmong> parts);
    [[nodiscard]] Vec2 localBeam(std::size_t beam) const;

    const RayScenes* worlds_;
    const MovingBodies* bodies_;
    const Sensor* sensor_;
    ReadingOptions options_;
    std::uint64_t id_hash_;
    std::uint32_t own_;
    Beams beams_;
    std::vector<float> cosines_, errors_;
};

/// Returns the distance to the first surface of every beam up to max_range, ignoring min_range;
/// +infinity without a surface. Metrics are computed from these distances.
std::vector<float> castBeams(const RayWorld& world, const Sensor& sensor);

/// Computes eq. (4.4) of the thesis: the sum of step * pi * dist^2 / 360 over all beams; no return
/// counts as max_range. \pre ranges are those of castBeams
double sliceArea(const Laser& laser, std::span<const float> ranges);

}  // namespace ispace
