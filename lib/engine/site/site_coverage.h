// SPDX-License-Identifier: GPL-3.0-or-later
// The coverage of a building: that of its storeys, and their sums.
//
// Figures are those of measureCoverage() for each storey, with the views of other storeys' sensors
// through shafts and over stairs. Areas add up; a share of the building is a sum of areas over the
// floor of all storeys, and empty if that of a storey is unknown. Storeys in equal surroundings are
// measured once. Deterministic for any number of threads.
//
//     const SiteCoverage measured = measureSite(building, {.plane = 0});
//     const std::optional<double> share = measured.coverage.exact;
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "coverage/requirement.h"
#include "report/coverage_report.h"
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
};

/// Measures the floor of all storeys, without openings in it; those with equal rooms and views
/// once. Rangers and cameras see through shafts and over stairs, see viewsBetweenStoreys().
/// \param progress see measureCoverage(), for each storey
SiteCoverage measureSite(const SiteScene& building, const CoverageOptions& options,
                         Progress* progress = nullptr);

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

/// Sections of a report: those about all floor, and those about each storey. A section of a storey
/// has the name of one about all floor.
struct SiteParts {
    ReportParts sum = {};
    std::vector<ReportParts> storeys = {};  ///< empty: none
};

/// Adds the sections of one kind, made of a result of each storey and of their sum.
template <typename Section, typename Result>
void addSections(SiteParts& parts, const std::vector<Result>& storeys, const Result& sum) {
    parts.storeys.resize(storeys.size());
    for (std::size_t i = 0; i < storeys.size(); ++i)
        parts.storeys[i].push_back(std::make_shared<Section>(storeys[i]));
    parts.sum.push_back(std::make_shared<Section>(sum));
}

/// Writes one JSON object and a newline, schema ispace-coverage/1 with an item of `rooms` for each
/// storey; of a room alone coverageJson().
std::string siteCoverageJson(const SiteScene& building, const SiteCoverage& coverage,
                             const SiteParts& parts = {});
/// Returns the sections of a room alone: its own, and those about all floor that it lacks.
ReportParts partsOfRoom(const SiteParts& parts);
/// Writes the report of each storey, then a table of all, and the sections of the building; of a
/// room alone its report.
std::string siteCoverageText(const SiteScene& building, const SiteCoverage& coverage,
                             const SiteParts& parts = {});

}  // namespace ispace
