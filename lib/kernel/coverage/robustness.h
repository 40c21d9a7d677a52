// SPDX-License-Identifier: GPL-3.0-or-later
// How much coverage suffers from errors of mounting and from failures of sensors.
//
// Mountings are sampled: random numbers are keyed by seed, sample and sensor (base/random.h), so
// sample k is the same whatever samples ran before, on any number of threads. Failures are
// enumerated: the worst case is the least over all sets of so many sensors, no heuristic.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "coverage/coverage.h"
#include "coverage/requirement.h"
#include "scene/scene.h"

namespace ispace {

/// The largest error with which sensors are mounted.
struct MountingTolerance {
    double distance = 0;  ///< in the plan, metres
    Angle angle;          ///< of the heading, and of the tilt of sensors that scan no slice
};

/// Parses `5cm,3deg`. \throws UsageError for negative numbers, more than a metre or 180 degrees
MountingTolerance parseTolerance(std::string_view text);

/// Returns the pose of a sensor mounted with a random error: heading, and tilt unless the sensor
/// scans a slice, uniform within the angle; position uniform in the disc about the planned one.
/// Displacements across a wall or a body, into one, or out of the room are drawn again, eight times
/// at most; then the sensor keeps its position. Sensors on robots and people keep their poses.
/// \param key its `sensor` is ignored
Pose3 mountedPose(const Environment& environment, const Sensor& sensor,
                  const MountingTolerance& tolerance, RandomKey key);

/// The values of a figure in several samples.
struct FigureSpread {
    Requirement figure;  ///< without its share
    std::string name;
    double planned = 0;
    bool is_exact = false;
    std::vector<double> values = {};  ///< ascending; at least one

    /// Returns the least value that at least this share of the values does not exceed; the least
    /// of all for 0.
    [[nodiscard]] double quantile(double share) const;
    [[nodiscard]] double mean() const;
    /// Returns the standard error of the mean of independent values; 0 for a single one.
    [[nodiscard]] double standardError() const;
};

/// Figures of random variants of a scene.
struct SampledFigures {
    int samples = 0;
    std::vector<FigureSpread> figures;
    std::vector<int> met;  ///< of each requirement: number of samples that meet it
};

/// Measures variants of a scene: coverage, free coverage, each zone, and the figures of the
/// requirements. Leaves out figures that are unknown as planned. Stops after the sample in
/// progress, and at least one, if progress says stop.
/// \param measured computes the coverage of sample k
SampledFigures sampleFigures(const CoverageReport& planned,
                             std::span<const Requirement> requirements, int samples,
                             const std::function<Coverage(int)>& measured, Progress& progress);

/// Samples random mountings of all sensors of a scene; mounting k draws from frame k of the seed.
/// \param planned coverage of the scene by `measure`
SampledFigures perturbMounting(const Scene& scene, const CoverageReport& planned,
                               const CoverageOptions& measure, const MountingTolerance& tolerance,
                               int mountings, std::uint64_t seed,
                               std::span<const Requirement> requirements, Progress& progress);

/// The worst failure for a figure.
struct FigureLoss {
    Requirement figure;  ///< without its share
    std::string name;
    double planned = 0;
    bool is_exact = false;
    double worst = 0;                       ///< without these sensors
    std::vector<std::string> sensors = {};  ///< the first such set, in the order of the scene
};

/// Finds, for each figure of sampleFigures(), the `count` sensors whose failure lowers it most:
/// the minimum over all sets of so many sensors, or of all if there are fewer. Floor seen only by
/// failed sensors is lost, and so is floor heard by fewer than kMinReceivers of the others. Exact,
/// by the faces of an overlay, where the regions of at most 62 sensors are known; else by cells.
/// O(sets x distinct groups of sensors that see floor).
/// \throws UsageError if these are more than two billion
std::vector<FigureLoss> worstFailures(const Scene& scene, const Coverage& coverage, int count,
                                      std::span<const Requirement> requirements);

/// A room of a site, whose sensors may fail. A sensor that other rooms see, too, has one id.
struct FailingRoom {
    const Scene& scene;
    const Coverage& coverage;
};
/// The same over all floor of several rooms. \param planned sums over the rooms, with the zones of
/// all in their order
std::vector<FigureLoss> worstFailures(std::span<const FailingRoom> rooms,
                                      const CoverageReport& planned, int count,
                                      std::span<const Requirement> requirements);

}  // namespace ispace
