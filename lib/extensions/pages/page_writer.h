// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/pages: reports for people, as pages in HTML and PDF, and the material of a layout.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/page.h"

namespace ispace::pages {

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
