// SPDX-License-Identifier: GPL-3.0-or-later
// Rules of cameras, on faces and privacy, in the storeys of a site.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "extensions/camerarules/camera_rules.h"
#include "extensions/camerarules/camera_rules_report.h"
#include "site/site_coverage.h"

namespace ispace::camerarules {

/// Measures rules of facing and of privacy in the storeys that have their doors or zones; a rule
/// `GLOB/ZONE` or `GLOB/door:...` only in storeys with matching ids. Cameras of other storeys
/// count, as for the floor. Returns the results by storey. Measures the building once for each
/// density of privacy that differs from that of the coverage. \param options of the coverage
/// \throws UsageError for a rule that no storey has, with the doors or zones of all storeys
std::vector<CameraRules> measureSiteRules(const SiteScene& building, const SiteCoverage& coverage,
                                          const CoverageOptions& options,
                                          std::span<const FacingRule> facing,
                                          std::span<const PrivacyRule> privacy);
/// Returns the rules that a storey has, with its id before those of zones and doors, as in its
/// scene of wholeScenes(). \throws UsageError for a rule that no storey has
struct StoreyRules {
    std::vector<FacingRule> facing;
    std::vector<PrivacyRule> privacy;
};
StoreyRules rulesOfStorey(const SiteScene& building, const SiteCoverage& coverage,
                          std::size_t storey, std::span<const FacingRule> facing,
                          std::span<const PrivacyRule> privacy);
/// Returns the floor that falls short of rules, m2: faces that are not seen, and private floor that
/// is.
double missingFloor(std::span<const CameraRules> rules);
/// Returns the rules of all storeys, with the storey before each.
std::vector<JudgedRule> judgedInSite(const SiteScene& building, std::span<const CameraRules> rules);

/// Adds the sections of rules. \param rules by storey; empty: none
void addRules(SiteParts& parts, const SiteScene& building, const SiteCoverage& coverage,
              const std::vector<CameraRules>& rules);

}  // namespace ispace::camerarules
