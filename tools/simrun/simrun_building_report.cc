// SPDX-License-Identifier: GPL-3.0-or-later
// --report and --suggest of the run of a building.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "building/building_coverage.h"
#include "building/building_page.h"
#include "building/building_suggestions.h"
#include "cli/common_options.h"
#include "cli/progress_bar.h"
#include "simrun/simrun_report.h"

namespace ispace {

namespace {

BuildingRunCoverage measuredRun(const SimrunOptions& options, const BuildingScene& building) {
    std::vector<std::string> repeated;  // warnings that the run itself gave
    return measureBuildingRun(building, options.record, {}, options.rules.max_work, repeated);
}

/// Returns the share of the time of all movers for which a sensor saw them; empty if none was on a
/// storey.
std::optional<double> shareSeen(const SimrunOptions& options, const BuildingScene& building) {
    const BuildingRunCoverage run = measuredRun(options, building);
    if (run.sum.all.time_shares.empty()) return std::nullopt;
    return 1 - run.sum.all.time_shares.front();
}

}  // namespace

std::string buildingReportFile(const SimrunOptions& options, const SiteInput& input,
                               const RunJudge& judge, const std::string& command) {
    const BuildingScene& building = input.building;
    const BuildingCoverage coverage = measureBuilding(building, {});
    const BuildingRunCoverage run = measuredRun(options, building);
    const std::string suffix = suffixOf(options.report);
    if (suffix == "json") return buildingCoverageJson(building, coverage, partsOf(run));
    BuildingPageInput page{building, coverage, "", command, {}, partsOf(run)};
    if (input.environment_operand != "-") page.name = baseName(input.environment_operand);
    for (const RunVerdict& verdict : judge.verdicts())
        page.requirements.push_back({verdict.expectation, verdict.is_met, verdict.reason});
    const ReportPage pages = buildingPage(page);
    return suffix == "pdf" ? pdfOf(pages) : htmlOf(pages);
}

std::string buildingSuggestionsText(const SimrunOptions& options, const SiteInput& input) {
    std::vector<RunSuggestion> found;
    const BuildingScene& building = input.building;
    const std::optional<double> before = shareSeen(options, building);
    const auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    const auto whole = wholeScenes(building);
    progress->begin("storeys", static_cast<std::int64_t>(whole.size()));
    for (std::size_t i = 0; before && i < whole.size() && !progress->stopped(); ++i) {
        progress->advance(1);
        if (whole[i] == nullptr) continue;
        SilentProgress silent;
        for (Suggestion& change : suggestForStorey(building, i, whole, {}, silent)) {
            using Kind = Suggestion::Kind;
            if (change.kind != Kind::Add && change.kind != Kind::Turn && change.kind != Kind::Shift)
                continue;
            const auto seen =
                shareSeen(options, editedStorey(building, i, *whole[i], change.edits));
            if (seen && *seen > *before) found.push_back({std::move(change), *seen});
        }
    }
    progress->end();
    return suggestionsText(options, input.named, std::move(found), before.value_or(0));
}

}  // namespace ispace
