// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of random variants of a scene: sensors mounted off their poses, and people in the way.
//
// Random numbers are keyed by seed, sample and sensor (base/random.h), so sample k is the same
// whatever samples ran before, on any number of threads. Each sample costs one measureCoverage().
//
//     const SampledFigures sampled = perturbMounting(scene, planned, measure, tolerance, 100, seed,
//                                                    requirements, progress);
//     print(sampled.figures.front().quantile(0.05));      // of coverage
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "coverage/coverage.h"
#include "coverage/requirement.h"
#include "extensions/robustness/crowd.h"
#include "extensions/robustness/mounting.h"
#include "scene/scene.h"

namespace ispace::robustness {

/// Returns the figures whose robustness is reported: coverage, free coverage, that of each zone,
/// and those of the requirements, each once, as requirements of 0.
std::vector<Requirement> figuresOf(const CoverageReport& report,
                                   std::span<const Requirement> requirements);

/// Returns the standard error of the mean of independent values; 0 for a single one.
double standardErrorOf(std::span<const double> values);

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

/// Returns the people of the scene at their start.
Crowd crowdOf(const Scene& scene);

/// Reads the people of a recorded run at up to `most` moments, spread evenly over the run from its
/// first moment to its last. People whom the scene does not have get the default height.
/// \throws FormatError as the reader, and for a record without a moment
std::vector<Crowd> crowdsOfRun(const std::string& folder, const Scene& scene, std::size_t most);

/// Measures the scene with each of these crowds, see sampleFigures().
/// \param planned coverage of the scene by `measure`
SampledFigures measureCrowds(const Scene& scene, const CoverageReport& planned,
                             const CoverageOptions& measure, std::span<const Crowd> crowds,
                             std::span<const Requirement> requirements, Progress& progress);

}  // namespace ispace::robustness
