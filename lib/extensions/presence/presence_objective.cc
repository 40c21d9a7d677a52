// SPDX-License-Identifier: GPL-3.0-or-later
// Ways are drawn or read room by room, with the seed of the run; a record's file counts among the
// files that the layout depends on.
#include <optional>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "base/run_files.h"
#include "extensions/presence/presence_demand.h"
#include "extensions/presence/presence_options.h"
#include "extensions/presence/presence_paths.h"

namespace ispace::presence {

namespace {

/// `arrange --presence`.
class PresenceObjective final : public ObjectiveGroup {
  public:
    [[nodiscard]] std::string_view word() const override { return ""; }
    [[nodiscard]] std::string_view help() const override { return ""; }
    [[nodiscard]] std::string_view option() const override { return "--presence"; }
    [[nodiscard]] bool isAsked() const override { return ways_.has_value(); }
    void declare(CommandLine& line) override {
        line.group("Goals of sensors of motion");
        line.parsed(
            "--presence", "DIR|wander:N[,TIME]",
            [this](const std::string& text) { ways_ = parseWays(text); },
            "instead of floor, the ways of people count on which PIR sensors and radars detect "
            "them within a second: of the run that simrun --record wrote to DIR, or of N people "
            "who wander for TIME (default 10min)",
            Enters::BaseNames);
    }
    [[nodiscard]] std::vector<std::shared_ptr<const Demand>> demandsIn(
        const SiteInput& site, std::span<const RoomGoals> /*goals*/, const ArrangeOptions& how,
        const CommonOptions& common, std::vector<std::string>& files) const override {
        std::vector<std::shared_ptr<const Demand>> demands;
        const std::vector<RoomPaths> ways =
            waysIn(site, "--presence", *ways_, common.seed, how.plane);
        demands.reserve(ways.size());
        for (std::size_t i = 0; i < ways.size(); ++i) {
            if (!ways_->record.empty())
                files.push_back(RecordedFiles(ways[i].choice.record).robots);
            demands.push_back(presenceDemand(
                std::make_shared<PeoplePaths>(readPaths(ways[i], *site.rooms()[i])), how.plane));
        }
        return demands;
    }

  private:
    std::optional<PathsChoice> ways_;
};

}  // namespace

std::unique_ptr<ObjectiveGroup> makePresenceObjective() {
    return std::make_unique<PresenceObjective>();
}

}  // namespace ispace::presence
