// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a building as a page.
#pragma once

#include "cli/report_group.h"
#include "extensions/pages/coverage_page.h"
#include "report/page.h"

namespace ispace::pages {

/// The form of a page.
struct PageStyle {
    CoveragePageInput::Media media = CoveragePageInput::Media::Any;  ///< of a room alone
    PageCover cover = {};
    Paper paper = Paper::A4;
    PriceList prices = {};
};

/// Builds the report of a building, of a room alone coveragePage(): summary, requirements, figures
/// by storey and in sum; map, figures and the sheet of the installer of each storey; the material
/// of all. With a cover each camera has a sheet.
ReportPage sitePage(const SiteReport& input, const PageStyle& style);

}  // namespace ispace::pages
