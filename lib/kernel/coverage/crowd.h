// SPDX-License-Identifier: GPL-3.0-or-later
// Coverage among people, whose bodies block sight.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "coverage/robustness.h"
#include "scene/scene.h"

namespace ispace {

/// Height of people whose height is not known, metres.
constexpr double kUsualHeight = 1.7;

/// A person who blocks sight: an upright cylinder on the floor of humanRadius(height).
struct Bystander {
    Point2 place;
    double height = kUsualHeight;
};

/// People who are in the room at the same time.
using Crowd = std::vector<Bystander>;

/// Returns the scene with a cylinder for each person; sensors and digest stay. The environment
/// shares its walls with that of `scene`.
Scene withCrowd(const Scene& scene, const Crowd& crowd);

/// Returns the people of the scene at their start.
Crowd crowdOf(const Scene& scene);

/// Draws positions of `count` people of the default height, independent and uniform over those
/// where a person touches no wall, no body below the height, no sensor there and no one drawn
/// before. \throws UnmetError if a thousand draws find no such position for one of them
class CrowdFloor {
  public:
    /// Stores the reference.
    explicit CrowdFloor(const Scene& scene);
    [[nodiscard]] Crowd draw(std::size_t count, RandomKey key) const;

  private:
    [[nodiscard]] bool isFree(Point2 place) const;

    const Scene& scene_;
    Slice band_;
    std::vector<Segment2> lines_;
};

/// Reads the people of a recorded run at up to `most` moments, spread evenly over the run from its
/// first moment to its last. People whom the scene does not have get the default height.
/// \throws FormatError as the reader, and for a record without a moment
std::vector<Crowd> crowdsOfRun(const std::string& folder, const Scene& scene, std::size_t most);

/// Measures the scene with each of these crowds, see sampleFigures().
/// \param planned coverage of the scene by `measure`
SampledFigures measureCrowds(const Scene& scene, const CoverageReport& planned,
                             const CoverageOptions& measure, std::span<const Crowd> crowds,
                             std::span<const Requirement> requirements, Progress& progress);

}  // namespace ispace
