// SPDX-License-Identifier: GPL-3.0-or-later
// What coverage loses if sensors fail: the least over all sets of so many, no heuristic.
//
//     const std::vector<FigureLoss> losses = worstFailures(scene, coverage, 2, requirements);
//     print(losses.front().worst, losses.front().sensors);     // of coverage
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "coverage/coverage.h"
#include "coverage/requirement.h"
#include "scene/scene.h"

namespace ispace::robustness {

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

}  // namespace ispace::robustness
