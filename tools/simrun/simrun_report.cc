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
#include "site/site_suggestions.h"

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

namespace {

/// A change of a sensor, and the share of the time of all movers for which a sensor sees them after
/// it.
struct RunSuggestion {
    Suggestion change;
    double seen = 0;
};

/// Returns the share of the time of all movers for which a sensor saw them; empty if none was
/// there.
std::optional<double> seenShare(const SimrunOptions& options, const SiteScene& building) {
    const std::optional<SiteRunCoverage> run = recordedRun(options, building);
    if (!run || run->sum.all.time_shares.empty()) return std::nullopt;
    return 1 - run->sum.all.time_shares.front();
}

/// Returns the additions, turns and shifts of suggestForStorey() that raise the share.
std::vector<RunSuggestion> suggestForRun(const SimrunOptions& options, const SiteScene& building,
                                         double before) {
    const auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    const auto whole = wholeScenes(building);
    std::vector<RunSuggestion> found;
    SilentProgress silent;
    Progress& of_storey = building.isRoomAlone() ? *progress : silent;
    if (!building.isRoomAlone())
        progress->begin("storeys", static_cast<std::int64_t>(whole.size()));
    for (std::size_t i = 0; i < whole.size() && !progress->stopped(); ++i) {
        if (!building.isRoomAlone()) progress->advance(1);
        if (whole[i] == nullptr) continue;
        for (Suggestion& change : suggestForStorey(building, i, whole, {}, of_storey)) {
            using Kind = Suggestion::Kind;
            if (change.kind != Kind::Add && change.kind != Kind::Turn && change.kind != Kind::Shift)
                continue;
            const auto seen =
                seenShare(options, editedStorey(building, i, *whole[i], change.edits));
            if (seen && *seen > before) found.push_back({std::move(change), *seen});
        }
    }
    progress->end();
    return found;
}

}  // namespace

std::string suggestionsText(const SimrunOptions& options, const SiteInput& input) {
    SiteScene building = input.building;
    building.devices = shippedDevices();
    const std::optional<double> before = seenShare(options, building);
    if (!before) return "the run has no robots or people to see\n";
    std::vector<RunSuggestion> found = suggestForRun(options, building, *before);
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
                formatFixed(kPoints * (one.seen - *before), 2) +
                " points, robots and people are seen for " + percentText(one.seen) +
                " of their time\n    " +
                commandOf(editCommand(input.named, options.rules), one.change.edits) + '\n';
    return text;
}

}  // namespace ispace
