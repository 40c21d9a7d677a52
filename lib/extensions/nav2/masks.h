// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/nav2: zones and the floor that sensors cover become masks for the costmap filters
// of Nav2.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "io/exporters.h"
#include "report/coverage_formats.h"
#include "scene/scene.h"

namespace ispace::nav2 {

/// Writes a mask for Nav2's keep-out filter, with the cells of writeRosMap(). Cells with their
/// centre in a zone or on its edge are marked; a zone too small for that marks the cell around its
/// centre.
/// \throws UsageError as readZone() and writeRosMap(), and for a zone beside the map
ExportedFiles writeKeepoutMask(const Scene& scene, const std::vector<std::string>& zones,
                               double resolution, const std::string& image_name);

/// Writes a mask for Nav2's speed filter, as nav2MaskFiles() does: free floor that k sensors see
/// gets the k-th of `speeds`, or the last one; elsewhere speed is not limited. \param speeds shares
/// of full speed, 0.01 to 1, to a hundredth \pre cells are squares of `cell` metres
CoverageFiles coverageSpeedMask(const Coverage& coverage, double cell,
                                std::span<const double> speeds, const std::string& picture_name);
/// Writes a mask for Nav2's keep-out filter: free floor that no sensor sees.
CoverageFiles coverageKeepoutMask(const Coverage& coverage, double cell,
                                  const std::string& picture_name);

/// Adds the masks to the formats of rooms and of coverage.
void addMasks();

}  // namespace ispace::nav2
