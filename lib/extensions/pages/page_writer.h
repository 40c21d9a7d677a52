// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/pages: reports for people, as pages in HTML and PDF, and the material of a layout.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/page.h"

namespace ispace::pages {

/// Above the command at the end of a page. The command is that of the histories of layouts and
/// records, which has no threads, paths or texts of the page, so that pages have the same bytes.
constexpr const char* kCommandCaption =
    "The command of these figures; options without an effect on them are left out:";

/// Returns the lines of a cover, such as {"Client", "ACME"}.
std::vector<std::pair<std::string, std::string>> coverLines(const PageCover& cover);

/// Writes units in texts and tables as people do, m² for m2. Code to copy keeps its text.
ReportPage typeset(ReportPage page);

/// Writes the page as one HTML file without references to others: styles, script and pictures are
/// inside. It is well-formed XML, too. Equal pages give equal bytes.
std::string htmlOf(const ReportPage& page);

/// Writes the page as PDF on upright sheets of its paper. Figures in millimetres keep their scale
/// if they fit. Equal pages give equal bytes.
std::string pdfOf(const ReportPage& page);
/// Returns the sheets of that PDF, in millimetres.
std::vector<Picture> sheetsOf(const ReportPage& page);

}  // namespace ispace::pages
