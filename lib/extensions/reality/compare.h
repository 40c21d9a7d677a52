// SPDX-License-Identifier: GPL-3.0-or-later
// Simulates the readings of a log in a plan, and measures their residuals: measured range less
// simulated range.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "extensions/reality/log.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

namespace ispace::reality {

/// The rays of a scan in the world.
struct MeasuredRays {
    Directions directions;
    std::vector<Point3> origins;  ///< one, or one for each ray of a sensor that moves meanwhile
    [[nodiscard]] Point3 end(std::size_t ray, double range) const {
        return origins[origins.size() == 1 ? 0 : ray] + range * directions[ray];
    }
};

/// A scan or a cloud of a log, with the pose that it is simulated at.
struct MeasuredScan {
    std::size_t sensor = 0;         ///< index in LoggedRun::sensors
    const LogScan* scan = nullptr;  ///< of these two, one is set
    const LogCloud* cloud = nullptr;
    Pose3 pose;
    std::size_t first_beam = 0;  ///< of its beams in LoggedRun::beams
    /// Motion of the sensor from this scan to the next, in its frame, if beams differ in time.
    std::optional<Pose2> motion = {};
    std::vector<double> shares = {};  ///< of that motion at the time of each beam

    [[nodiscard]] double time() const { return scan != nullptr ? scan->time : cloud->time; }
    [[nodiscard]] const std::vector<float>& ranges() const {
        return scan != nullptr ? scan->ranges : cloud->ranges;
    }
    /// Computes its rays in the world, from this pose of the sensor at its first beam.
    [[nodiscard]] MeasuredRays rays(const Pose3& at) const;
};

/// A sensor of the log.
struct MeasuredSensor {
    std::string id;
    std::optional<Sensor> known = {};  ///< of LAYOUT or --model
    double min_range = 0, max_range = 0;
    bool stands = false;  ///< its pose is that of LAYOUT, the same for all scans
};

/// A beam beside its simulation.
struct MeasuredBeam {
    float measured = 0, expected = 0;  ///< metres; +infinity is no return
    float cosine = 1;                  ///< of the angle of incidence on the simulated surface
    std::int32_t surface = -1;         ///< index in Environment::elements(); -1: unknown
    [[nodiscard]] bool hasBoth() const { return measured < kNoReturn && expected < kNoReturn; }
    [[nodiscard]] double residual() const { return double{measured} - double{expected}; }
};

/// The scans of a log with poses, and their simulation.
struct LoggedRun {
    std::vector<MeasuredSensor> sensors;
    std::vector<MeasuredScan> scans;
    std::vector<MeasuredBeam> beams;  ///< of all scans, in their order
    std::size_t left_out = 0;         ///< scans without a pose
    std::size_t outside = 0;          ///< scans from points inside a solid or outside the room
    std::vector<std::string> doubts;  ///< a sentence each

    [[nodiscard]] std::span<const MeasuredBeam> beamsOf(const MeasuredScan& scan) const {
        return std::span(beams).subspan(scan.first_beam, scan.ranges().size());
    }
};

struct LoggedRunOptions {
    std::vector<std::string> select = {};  ///< globs of sensors of the log; empty: all
    std::optional<Sensor> model = {};      ///< of --model
};

/// Matches the sensors of a log with those of a scene and gives each scan its pose: that of the log
/// for a sensor that moves, that of LAYOUT for one that stands still. A planar log (height 0) takes
/// the height of the sensor in LAYOUT, else kScanHeight. \pre `log` outlives the run
/// \throws UsageError for a sensor that stands still and has no pose in LAYOUT, or for a glob that
/// matches no sensor; FormatError if no scan has a pose
LoggedRun runOf(const Log& log, const Scene& scene, const LoggedRunOptions& options);

/// Finds the element of a point on a surface. Thread-safe.
class SurfaceFinder {
  public:
    explicit SurfaceFinder(const Environment& environment);
    ~SurfaceFinder();
    SurfaceFinder(const SurfaceFinder&) = delete;
    SurfaceFinder& operator=(const SurfaceFinder&) = delete;
    /// Prepares the slice of a level scan.
    void prepare(double height);
    /// Returns the index of the element that has a surface within 2 cm of the point, at the nearest
    /// prepared height; -1 without one.
    [[nodiscard]] std::int32_t elementAt(Point3 point) const;

  private:
    struct Slices;
    std::unique_ptr<Slices> slices_;
};

/// Simulates all scans at their poses and stores the beams. Uses all cores.
void simulate(LoggedRun& run, RayScenes& worlds, SurfaceFinder& surfaces);

/// Simulates one scan at a pose. \pre the worlds are prepared for it
void castMeasured(const RayScenes& worlds, const LoggedRun& run, const MeasuredScan& scan,
                  const Pose3& pose, std::span<float> expected, std::span<float> cosines);

}  // namespace ispace::reality
