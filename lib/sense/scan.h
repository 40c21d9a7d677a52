// SPDX-License-Identifier: GPL-3.0-or-later
// lib/sense: sensors and the formats of their readings. Uses render and below; TBB inside.
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

/// True for a laser whose scans all lie in the slice at its height: level, and turning about the
/// vertical if it sweeps.
bool scansSlice(const Laser& laser, const Pose3& pose);
bool scansSlice(const Sensor& sensor);

/// Bearings between the first and the last beam of a laser, ends included.
struct BearingWindow {
    Vec2 middle;    ///< of unit length
    double cosine;  ///< of half the window, -1 if it is all around
    explicit BearingWindow(const Laser& laser, Angle more = {});
    /// For a place in the scan plane, in the sensor's frame; its own place is.
    [[nodiscard]] bool holds(Vec3 local) const;
};

/// Where a scan plane that is not level passes above or below the floor.
class ScanPlane {
  public:
    explicit ScanPlane(const Pose3& pose)
        : frame_(pose), up_(frame_.forward.x * frame_.left.y - frame_.forward.y * frame_.left.x) {}

    [[nodiscard]] const Frame3& frame() const { return frame_; }
    /// Vertical part of the normal; 0 if the plane stands upright.
    [[nodiscard]] double up() const { return up_; }
    /// Height of the plane over a place. \pre up() is not 0
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

/// The scans of a laser that changes one angle of its pose, and all between them: which places they
/// pass, if nothing stands in the way.
class SweptScan {
  public:
    /// \pre placed.as<Laser>().sweep is not None
    explicit SweptScan(const Sensor& placed);

    /// True if some scan of the sweep has the place between its first and last beam.
    [[nodiscard]] bool passes(Point3 place) const;

  private:
    struct Turns {
        CosSin heading, tilt, roll;
        [[nodiscard]] Vec3 toSensor(Vec3 way) const;
    };
    /// The place lies in the scan plane where x cos s + y sin s + z = 0 for the swept angle s.
    [[nodiscard]] Vec3 equationOf(Vec3 way) const;
    [[nodiscard]] bool isSeenAt(CosSin swept, Vec3 way) const;
    [[nodiscard]] CosSin& sweptOf(Turns& turns) const;

    SweepAxis axis_;
    Point3 origin_;
    Turns turns_;           // at the beginning
    CosSin middle_;         // of the swept angle
    double cosine_;         // of half the sweep, -1 if it is a full turn
    BearingWindow window_;  // of one scan
    BearingWindow wide_;    // of all, where the scan plane turns in itself
};

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

/// Unit vectors of lasers' beams in the lasers' frames, kept once for all whose beams are alike:
/// those of each of thousands would not stay in the processor's cache.
class LocalBeams {
  public:
    /// z is 0.
    std::shared_ptr<const Directions> of(const Laser& laser);

  private:
    std::map<std::tuple<Angle, Angle, int>, std::shared_ptr<const Directions>> known_;
};

/// Directions of the beams of one sensor; those of a sensor that stands are kept from scan to scan.
///
/// Sums of degrees are exact where products of cosines are not: a level beam at 45 degrees of a
/// sensor that faces 45 degrees runs exactly along y. The beams of a sensor that moves (`turns`)
/// are rotated as a whole instead, which is faster.
class Beams {
  public:
    /// \param local those of this laser, if others share them
    Beams(const Laser& laser, bool turns, std::shared_ptr<const Directions> local = nullptr);
    /// Unit vectors of all beams in the world frame; valid until this thread asks for any others.
    const Directions& at(const Pose3& pose);
    /// Unit vectors in the sensor's frame.
    [[nodiscard]] const Directions& local() const { return *local_; }

  private:
    void turn(const Pose3& pose, Directions& directions) const;
    void point(const Pose3& pose);

    Angle first_, step_;
    bool turns_;
    std::shared_ptr<const Directions> local_;
    Directions directions_;  // of a sensor that stands
    bool known_ = false;     // directions_ are those of:
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

/// Where the beams of a level laser leave if it moves during the scan, one array per component:
/// each beam's place, and unit vectors along the laser's headings.
struct BeamFrames {
    std::vector<double> x, y, cos, sin;

    void resize(std::size_t count) {
        for (auto* const values : {&x, &y, &cos, &sin}) values->resize(count);
    }
};

/// Takes scans of one laser, keeping its memory and what can be computed once. Not thread-safe: use
/// one per thread or per sensor. Results do not depend on earlier scans.
class LaserCaster {
  public:
    /// `turns`, `local`: see Beams. \pre the references outlive it
    LaserCaster(const Worlds& worlds, const MovingBodies& bodies, const Sensor& sensor, bool turns,
                const ReadingOptions& options, std::shared_ptr<const Directions> local = nullptr);
    /// Sets the ranges of a scan from its frame, number, pose and beam_poses, including the blind
    /// zone and, if wanted, noise. \pre the worlds are prepared for the pose, and their mesh if
    /// beam_poses are not all level and at its height
    void cast(Scan& scan);
    /// The same while bodies move. \pre `parts` hold each beam once
    void cast(Scan& scan, std::span<const BeamsAmong> parts);
    /// The same for a laser that stays level at its height, in place of beam_poses.
    /// \pre `frames` has one for each beam
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

    const Worlds* worlds_;
    const MovingBodies* bodies_;
    const Sensor* sensor_;
    ReadingOptions options_;
    std::uint64_t id_hash_;
    std::uint32_t own_;
    Beams beams_;
    std::vector<float> cosines_, errors_;
};

/// Distance to the first surface of every beam up to max_range, whatever min_range is; +infinity
/// if there is none. Metrics are computed from these.
std::vector<float> castBeams(const RayWorld& world, const Sensor& sensor);

/// Eq. (4.4) of the thesis: the sum of step * pi * dist^2 / 360 over all beams, where no return
/// counts as max_range. \pre ranges are those of castBeams
double sliceArea(const Laser& laser, std::span<const float> ranges);

}  // namespace ispace
