// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "building/building_coverage.h"
#include "report/page/coverage_page.h"
#include "report/page/page.h"

namespace ispace {

struct BuildingPageInput {
    const BuildingScene& building;
    const BuildingCoverage& coverage;
    std::string name;     ///< base name of ENV; "" from stdin
    std::string command;  ///< as in histories
    std::vector<JudgedRequirement> requirements = {};
    const BuildingRunCoverage* run = nullptr;  ///< null: without
    const Advice* advice = nullptr;            ///< null: without
    std::vector<PageSection> more = {};        ///< after the storeys' table
};

/// Builds the report of a building: summary, requirements, figures by storey and in sum, then map
/// and figures of each storey.
ReportPage buildingPage(const BuildingPageInput& input);

}  // namespace ispace
