// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/simrun_report.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "arrange/suggestion.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "cli/progress_bar.h"
#include "coverage/run_coverage.h"
#include "report/page/coverage_page.h"
#include "report/suggestion_report.h"
#include "scene/placement_schemas.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

/// Measures the sight of robots and people in the record; empty if it has none.
std::optional<RunCoverage> recordedRun(const SimrunOptions& options, const Scene& scene) {
    if (!RunReader(options.record).next()) return std::nullopt;
    RunReader reader(options.record);
    RunChanges changes = changesOfRun(options.record, scene, options.rules.max_work);
    return measureRun(scene, reader, {}, &changes);
}

}  // namespace

std::string reportFile(const SimrunOptions& options, const SiteInput& input, const RunJudge& judge,
                       const std::string& command) {
    if (!input.isOneRoom()) return buildingReportFile(options, input, judge, command);
    const Scene& scene = input.only();
    Worlds worlds(scene.environment);
    const auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    const Coverage coverage = measureCoverage(scene, worlds, {}, progress.get());
    std::optional<RunCoverage> run = recordedRun(options, scene);
    if (run) run->name = baseName(options.record);
    CoveragePageInput page{scene, coverage, "", command};
    if (input.environment_operand != "-") page.name = baseName(input.environment_operand);
    for (const RunVerdict& verdict : judge.verdicts())
        page.requirements.push_back({verdict.expectation, verdict.is_met, verdict.reason});
    page.parts.run = run ? &*run : nullptr;
    page.progress = progress.get();
    const std::string suffix = suffixOf(options.report);
    if (suffix == "json") return coverageJson(coverage.report, {.run = page.parts.run});
    const ReportPage pages = coveragePage(page);
    return suffix == "pdf" ? pdfOf(pages) : htmlOf(pages);
}

namespace {

/// Returns the share of the time of all movers for which a sensor saw them; empty if none was
/// there.
std::optional<double> seenShare(const SimrunOptions& options, const Scene& scene) {
    const std::optional<RunCoverage> run = recordedRun(options, scene);
    if (!run || run->all.time_shares.empty()) return std::nullopt;
    return 1 - run->all.time_shares.front();
}

/// Returns the additions, turns and shifts of suggestChanges() that raise the share.
std::vector<RunSuggestion> suggestForRun(const SimrunOptions& options, const Scene& scene,
                                         double before) {
    const auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    SuggestOptions wanted;
    wanted.most = 7;  // one of each kind
    Worlds worlds(scene.environment);
    const Coverage coverage = measureCoverage(scene, worlds, wanted.measure, progress.get());
    std::vector<RunSuggestion> found;
    for (Suggestion& change :
         suggestChanges(scene, coverage, wanted, shippedDevices(), *progress)) {
        using Kind = Suggestion::Kind;
        if (change.kind != Kind::Add && change.kind != Kind::Turn && change.kind != Kind::Shift)
            continue;
        const Scene changed =
            makeScene(edited(scene.records, change.edits, sceneSchemas()), scene, shippedDevices());
        const std::optional<double> seen = seenShare(options, changed);
        if (seen && *seen > before) found.push_back({std::move(change), *seen});
    }
    return found;
}

}  // namespace

std::string suggestionsText(const SimrunOptions& options, const SiteInput& input) {
    if (!input.isOneRoom()) return buildingSuggestionsText(options, input);
    const std::optional<double> before = seenShare(options, input.only());
    if (!before) return "the run has no robots or people to see\n";
    return suggestionsText(options, input.named, suggestForRun(options, input.only(), *before),
                           *before);
}

std::string suggestionsText(const SimrunOptions& options, const std::vector<std::string>& named,
                            std::vector<RunSuggestion> found, double before) {
    constexpr double kPoints = 100;
    std::stable_sort(
        found.begin(), found.end(),
        [](const RunSuggestion& a, const RunSuggestion& b) { return a.seen > b.seen; });
    if (found.empty()) return "no change of one sensor sees more of the run\n";
    if (const auto most = static_cast<std::size_t>(*options.suggestions); found.size() > most)
        found.erase(found.begin() + static_cast<std::ptrdiff_t>(most), found.end());
    std::string text = "suggestions:\n";
    for (const RunSuggestion& one : found)
        text += "  " + printable(one.change.text) + ": +" +
                formatFixed(kPoints * (one.seen - before), 2) +
                " points, robots and people are seen for " + percentText(one.seen) +
                " of their time\n    " +
                commandOf(editCommand(named, options.rules), one.change.edits) + '\n';
    return text;
}

}  // namespace ispace
