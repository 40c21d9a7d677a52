// SPDX-License-Identifier: GPL-3.0-or-later
// That a requirement has its --presence and a record its rooms is checked before coverage is
// measured; a person that a requirement names is looked up after it.
#include "extensions/presence/presence_options.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/run_files.h"
#include "extensions/presence/presence_paths.h"
#include "extensions/presence/presence_report.h"
#include "extensions/presence/presence_requirement.h"
#include "extensions/presence/site_presence.h"

namespace ispace::presence {

namespace {

/// `coverage --presence`.
class PresenceGroup final : public CoverageGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Presence");
        line.parsed(
            "--presence", "DIR|wander:N[,TIME]",
            [this](const std::string& text) { ways_ = parseWays(text); },
            "report the share of people's ways on which PIR sensors and radars detect them within "
            "a second: of the run that simrun --record wrote to DIR, or of N people who wander for "
            "TIME (default 10min)",
            Enters::Nothing);
    }

    [[nodiscard]] std::string_view requirements() const override {
        return "; of the ways of --presence presence:95%, presence:PERSON=95%";
    }

    [[nodiscard]] bool takesRequirement(const std::string& text) override {
        auto requirement = parsePresenceRequirement(text);
        if (!requirement) return false;
        requirements_.push_back(*std::move(requirement));
        return true;
    }

    void take(const CommandLine& /*line*/) override {
        if (!requirements_.empty() && !ways_)
            throw UsageError("--require " + requirementText(requirements_.front()) +
                             " judges ways of people: give them, too (--presence)");
    }

    [[nodiscard]] bool isAsked() const override { return ways_.has_value(); }

    void fit(const SiteInput& input) const override {
        if (!ways_->record.empty()) mustBeRecordOf(input, "--presence", ways_->record);
    }

    /// Measures each room: a record's ways, or wanderers on all free floor.
    void measure(const MeasuredSite& site, CoverageFindings& findings) override {
        const double plane = site.how.plane;
        const std::vector<RoomPaths> ways =
            waysIn(site.input, "--presence", *ways_, site.common.seed, plane);
        for (std::size_t i = 0; i < ways.size(); ++i) {
            if (!ways_->record.empty())
                findings.files.push_back(RecordedFiles(ways[i].choice.record).robots);
            Presence presence = measurePresence(*site.coverage.floors[i],
                                                readPaths(ways[i], *site.input.rooms()[i]), plane);
            nameWholly(site.input.building.document.storeys[i], ways_->record.empty(), presence);
            rooms_.push_back(std::move(presence));
        }
        all_ = sumOverStoreys(rooms_);
        addSections<PresenceSection>(findings.parts, rooms_, all_);
        for (const PresenceRequirement& requirement : requirements_)
            findings.judged.push_back({requirementText(requirement), requirementPhrase(requirement),
                                       checkRequirement(requirement, all_)});
    }

  private:
    std::optional<PathsChoice> ways_;
    std::vector<PresenceRequirement> requirements_;
    std::vector<Presence> rooms_;
    Presence all_;
};

}  // namespace

std::unique_ptr<CoverageGroup> makePresence() { return std::make_unique<PresenceGroup>(); }

}  // namespace ispace::presence
