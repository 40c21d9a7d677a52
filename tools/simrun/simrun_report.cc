// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/simrun_report.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "cli/progress_bar.h"
#include "cli/storey_operands.h"
#include "scene/run/run_reader.h"
#include "site/site_coverage.h"
#include "site/site_page.h"

namespace ispace {

namespace {

/// Measures the sight of robots and people in the record; empty if that of a room has none.
std::optional<SiteRunCoverage> recordedRun(const SimrunOptions& options,
                                           const SiteScene& building) {
    if (building.isRoomAlone() && !RunReader(options.record).next()) return std::nullopt;
    std::vector<std::string> repeated;  // warnings that the run itself gave
    return measureSiteRun(building, options.record, {}, options.rules.max_work, repeated);
}

}  // namespace

std::string reportFile(const SimrunOptions& options, const SiteInput& input, const RunJudge& judge,
                       const std::string& command) {
    const SiteScene& building = input.building;
    const auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    const SiteCoverage coverage = measureSite(building, {}, progress.get());
    const std::optional<SiteRunCoverage> run = recordedRun(options, building);
    SiteParts parts;
    if (run) addRun(parts, building, *run);
    const std::string suffix = suffixOf(options.report);
    if (suffix == "json") return siteCoverageJson(building, coverage, parts);
    SitePageInput page{building, coverage, "", command, {}, parts};
    if (input.environment_operand != "-") page.name = baseName(input.environment_operand);
    for (const RunVerdict& verdict : judge.verdicts())
        page.requirements.push_back({verdict.expectation, verdict.is_met, verdict.reason});
    page.progress = progress.get();
    const ReportPage pages = sitePage(page);
    return suffix == "pdf" ? pdfOf(pages) : htmlOf(pages);
}

}  // namespace ispace
