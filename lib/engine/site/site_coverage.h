// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coverage/camera_rules.h"
#include "coverage/coverage.h"
#include "coverage/requirement.h"
#include "report/camera_rules_report.h"
#include "report/coverage_report.h"
#include "report/suggestion_report.h"
#include "site/site_run_coverage.h"
#include "site/site_scene.h"

namespace ispace {

/// The coverage of each storey, and their sums: areas add up, shares are of all floor. Ids in the
/// reports name the storey, as in "ground/l1". Of a room alone the figures are its own.
struct SiteCoverage {
    std::vector<Coverage> storeys;                     ///< with the views from other storeys
    std::vector<std::shared_ptr<const Scene>> floors;  ///< what was measured, Coupling::floors()
    std::vector<std::size_t> sensors;           ///< number of those that stand in each storey
    double indoor_area = 0, free_area = 0;      ///< m2
    Metric total_effective_area;                ///< m2
    std::optional<double> outside;              ///< see CoverageReport, m2
    Metric coverage, free_coverage;             ///< shares; empty if that of a storey is unknown
    std::vector<double> redundancy;             ///< see CoverageReport
    std::optional<Comparison> comparison = {};  ///< with another layout, see compareStoreys()
    std::vector<CameraRules> rules = {};        ///< by storey; empty: none
};

/// Measures the floor of all storeys, without openings in it; those with equal rooms and views
/// once. Rangers and cameras see through shafts and over stairs, see viewsBetweenStoreys().
/// \param progress see measureCoverage(), for each storey
SiteCoverage measureSite(const SiteScene& building, const CoverageOptions& options,
                         Progress* progress = nullptr);

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

/// Returns the rows of a table, its heads first: storeys, then the building.
std::vector<TextRow> storeyRows(const SiteScene& building, const SiteCoverage& coverage);
/// Returns the scale of redundancy that the maps of all storeys share, see MapOptions.
std::uint32_t redundancyScale(const SiteCoverage& coverage);

/// Returns the figures of the building as those of one floor: sums, shares of all floor, each
/// sensor with what it sees in all storeys, and the zones of all in their order, with whole ids.
CoverageReport sumOfStoreys(const SiteCoverage& coverage);

/// Checks the zone's name, `ID/NAME`. \throws UsageError for a zone that the building does not
/// have, with the nearest name
void mustHaveZone(const Requirement& requirement, const SiteScene& building);

/// Checks a requirement of a zone with the coverage of its storey, others with the sums of the
/// building. \throws as mustHaveZone()
Verdict checkRequirement(const Requirement& requirement, const SiteScene& building,
                         const SiteCoverage& coverage);

/// Compares the storeys and their sums with those of another layout of the same building.
void compareStoreys(SiteCoverage& coverage, const SiteCoverage& other, const std::string& name);

/// Parts of a report besides coverage: those of the building, and those of each storey.
struct SiteParts {
    ReportParts sum = {};
    std::vector<ReportParts> storeys = {};  ///< empty: none
};
/// Returns the parts of a run, which outlives them.
SiteParts partsOf(const SiteRunCoverage& run);

/// Writes one JSON object and a newline, schema ispace-coverage/1 with an item of `rooms` for each
/// storey; of a room alone coverageJson().
std::string siteCoverageJson(const SiteScene& building, const SiteCoverage& coverage,
                             const SiteParts& parts = {});
/// Returns the parts of a room alone, which is one storey and the sum.
ReportParts partsOfRoom(const SiteCoverage& coverage, const SiteParts& parts);
/// Writes the report of each storey, then a table of all, and the parts of the building; of a room
/// alone its report.
std::string siteCoverageText(const SiteScene& building, const SiteCoverage& coverage,
                             const SiteParts& parts = {});

}  // namespace ispace
