// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <vector>

#include "cli/extension.h"
#include "extensions/passages/building_run.h"
#include "extensions/passages/landing_check.h"

namespace ispace::extension {

namespace {

std::unique_ptr<BuildingWorlds> openRun(const SiteScene& building,
                                        const BuildingRunOptions& options) {
    return std::make_unique<passages::BuildingRun>(building, options);
}

std::vector<Diagnostic> findingsOf(const SiteScene& building) {
    std::vector<Diagnostic> findings = passages::BuildingRun::tripFindings(building);
    for (Diagnostic& finding : passages::landingFindings(building))
        findings.push_back(std::move(finding));
    return findings;
}

}  // namespace

Extension passages() {
    return {.name = "passages", .buildings = {.open = openRun, .findings = findingsOf}};
}

}  // namespace ispace::extension
