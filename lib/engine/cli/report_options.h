// SPDX-License-Identifier: GPL-3.0-or-later
// Options of a report that is handed over: its cover, paper, prices and material.
// checkReportOptions() is called after parsing, and reads the logo and the prices, so that errors
// in them are found before any work.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "report/page/coverage_page.h"

namespace ispace {

class CommandLine;

/// The words of these options as given.
struct ReportWords {
    PageCover cover;  ///< with the name of the logo's file
    std::string paper = "a4", prices, material;
    [[nodiscard]] bool isForPage() const { return cover.isGiven() || paper != "a4"; }
};

void addReportOptions(CommandLine& line, ReportWords& words);

/// Rejects options without the file that they are about. \param report name of the report's file;
/// "" without one \throws UsageError; FormatError, std::system_error for a bad logo or prices
void checkReportOptions(const ReportWords& words, const std::string& report);

/// Reads logo and prices. \throws FormatError for a logo that is no PNG picture, or a bad price
PageCover coverOf(const ReportWords& words);
PriceList pricesOf(const ReportWords& words);
Paper paperOf(const ReportWords& words);

/// Writes the file of --material, if asked for, of all these scenes. \returns a warning about
/// prices that no item of the material has; "" if there are none
std::string writeMaterialOf(const ReportWords& words,
                            std::span<const std::shared_ptr<const Scene>> scenes);

}  // namespace ispace
