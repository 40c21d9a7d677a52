// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "building/building_coverage.h"
#include "building/building_scene.h"
#include "coverage/camera_rules.h"
#include "report/camera_rules_report.h"

namespace ispace {

/// Measures rules of facing in the storeys that have their doors or zones; a rule `GLOB/ZONE` or
/// `GLOB/door:...` only in storeys with matching ids. Cameras of other storeys count, as for the
/// floor. Returns the results by storey.
/// \throws UsageError for a rule that no storey has, with the doors or zones of all storeys
std::vector<CameraRules> measureBuildingFacing(const BuildingScene& building,
                                               const BuildingCoverage& coverage,
                                               std::span<const FacingRule> rules);

/// Returns the rules of all storeys, with the storey before each.
std::vector<JudgedRule> judgedInBuilding(const BuildingScene& building,
                                         std::span<const CameraRules> rules);

}  // namespace ispace
