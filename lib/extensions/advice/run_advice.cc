// SPDX-License-Identifier: GPL-3.0-or-later
// Changes come from the scene (suggestChanges()), and are ranked by the run: the share of the time
// of all robots and people for which a sensor sees them, measured anew for each. They gain on the
// floor first; a change that gains only where people went may be missing.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/progress_bar.h"
#include "extensions/advice/advice.h"
#include "extensions/advice/site_suggestions.h"
#include "extensions/runs/site_run_coverage.h"
#include "scene/run/run_reader.h"

namespace ispace::advice {

namespace {

/// A change of a sensor, and the share of the time of all movers for which a sensor sees them after
/// it.
struct RunSuggestion {
    Suggestion change;
    double seen = 0;
};

/// Returns the share of the time of all movers for which a sensor saw them; empty if none was
/// there.
std::optional<double> seenShare(const RecordedRun& run, const SiteScene& building) {
    if (building.isRoomAlone() && !RunReader(run.record).next()) return std::nullopt;
    std::vector<std::string> repeated;  // warnings that the run itself gave
    const runs::SiteRunCoverage seen =
        runs::measureSiteRun(building, run.record, {}, run.rules.max_work, repeated);
    if (seen.sum.all.time_shares.empty()) return std::nullopt;
    return 1 - seen.sum.all.time_shares.front();
}

/// Returns the additions, turns and shifts of suggestForStorey() that raise the share.
std::vector<RunSuggestion> suggestForRun(const RecordedRun& run, const SiteScene& building,
                                         double before) {
    const auto progress = makeProgress("simrun", run.common.progress, run.common.quiet);
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
            const auto seen = seenShare(run, editedStorey(building, i, *whole[i], change.edits));
            if (seen && *seen > before) found.push_back({std::move(change), *seen});
        }
    }
    progress->end();
    return found;
}

/// Returns the lines of --suggest, in the form of coverage --suggest.
std::string adviceText(const RecordedRun& run, std::size_t most) {
    SiteScene building = run.input.building;
    building.devices = shippedDevices();
    const std::optional<double> before = seenShare(run, building);
    if (!before) return "the run has no robots or people to see\n";
    std::vector<RunSuggestion> found = suggestForRun(run, building, *before);
    constexpr double kPoints = 100;
    std::stable_sort(
        found.begin(), found.end(),
        [](const RunSuggestion& a, const RunSuggestion& b) { return a.seen > b.seen; });
    if (found.empty()) return "no change of one sensor sees more of the run\n";
    if (found.size() > most)
        found.erase(found.begin() + static_cast<std::ptrdiff_t>(most), found.end());
    std::string text = "suggestions:\n";
    for (const RunSuggestion& one : found)
        text += "  " + printable(one.change.text) + ": +" +
                formatFixed(kPoints * (one.seen - *before), 2) +
                " points, robots and people are seen for " + percentText(one.seen) +
                " of their time\n    " +
                commandOf(editCommand(operandsToEdit(run.input), run.rules), one.change.edits) +
                '\n';
    return text;
}

/// `simrun --suggest`.
class RunAdvice final : public RecordGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Suggestions");
        constexpr int kSuggestions = 3;  // one of each kind
        line.countOr(
            "--suggest", most_, kSuggestions, 1, kSuggestions,
            "with --record: at the end of the run report up to N changes of a sensor, to add, "
            "turn or move, after which robots and people would have been seen longer, each "
            "with its gain and its command",
            Enters::Nothing);
        line.essential({"--suggest"});
    }
    void take(const CommandLine& line) override {
        if (most_ && !line.given("--record"))
            throw UsageError("--suggest is about a recorded run: give --record DIR");
    }
    [[nodiscard]] bool isAsked() const override { return most_.has_value(); }
    void conclude(const RecordedRun& run) const override {
        writeAll("-", adviceText(run, static_cast<std::size_t>(*most_)));
    }

  private:
    std::optional<int> most_;
};

}  // namespace

std::unique_ptr<RecordGroup> makeRunAdvice() { return std::make_unique<RunAdvice>(); }

}  // namespace ispace::advice
