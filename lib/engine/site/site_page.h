// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a building as a page, which report/page writes as HTML or PDF.
#pragma once

#include <string>
#include <vector>

#include "report/page/coverage_page.h"
#include "report/page/page.h"
#include "site/site_coverage.h"

namespace ispace {

/// Contents of the page of a building. References are kept while the page is built.
struct SitePageInput {
    const SiteScene& building;
    const SiteCoverage& coverage;
    std::string name;     ///< base name of ENV; "" from stdin
    std::string command;  ///< as in histories
    std::vector<JudgedRequirement> requirements = {};
    SiteParts parts = {};
    CoveragePageInput::Media media = CoveragePageInput::Media::Any;  ///< of a room alone
    PageCover cover = {};
    Paper paper = Paper::A4;
    PriceList prices = {};
    std::vector<PageSection> more = {};     ///< after the storeys' table
    std::vector<Diagnostic> findings = {};  ///< about sensors, with their storeys
    Progress* progress = nullptr;           ///< of the pictures; null: silent
};

/// Builds the report of a building, of a room alone coveragePage(): summary, requirements, figures
/// by storey and in sum; map, figures and the sheet of the installer of each storey; the material
/// of all. With a cover each camera has a sheet.
ReportPage sitePage(const SitePageInput& input);

}  // namespace ispace
