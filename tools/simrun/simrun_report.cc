// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/simrun_report.h"

#include "base/file.h"
#include "cli/common_options.h"
#include "cli/progress_bar.h"
#include "site/site_coverage.h"

namespace ispace {

std::string reportFile(const SimrunOptions& options, const SiteInput& input, const RunJudge& judge,
                       const std::string& command) {
    const SiteScene& building = input.building;
    const auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    const SiteCoverage coverage = measureSite(building, {}, progress.get());
    SiteParts parts;
    options.records->report({input, options.record, options.common, options.rules}, parts);
    const ReportGroup* const form = options.reports->of(options.report);
    if (form == nullptr) return siteCoverageJson(building, coverage, parts);
    SiteReport report{building, coverage, "", command, {}, parts};
    if (input.environment_operand != "-") report.name = baseName(input.environment_operand);
    for (const RunVerdict& verdict : judge.verdicts())
        report.requirements.push_back({verdict.expectation, verdict.is_met, verdict.reason});
    report.progress = progress.get();
    return form->bytesOf(form->page(report, options.report), options.report);
}

}  // namespace ispace
