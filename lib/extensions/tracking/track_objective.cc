// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/tracking/track_objective.h"

#include "arrange/arrange.h"
#include "extensions/presence/presence_paths.h"
#include "extensions/tracking/track_demand.h"
#include "scene/run/run_reader.h"

namespace ispace::tracking {

namespace {

class TrackObjective : public ObjectiveGroup {
  public:
    [[nodiscard]] std::string_view word() const override { return "track"; }
    [[nodiscard]] std::string_view help() const override {
        return "the time for which a tracker follows people";
    }
    void declare(CommandLine& line) override {
        constexpr double kLongest = 3600;
        line.group("Goals of trackers");
        line.parsed(
            "--ways", "DIR|wander:N[,TIME]",
            [this](const std::string& text) { ways_ = presence::parseWays(text); },
            "people to track: those of the run that simrun --record wrote to DIR, or N wanderers "
            "for TIME (default wander:4,10min)",
            Enters::BaseNames);
        line.duration("--coast", loss_.coast, 0, kLongest,
                      "time for which a tracker follows an unseen person", Enters::History);
        line.duration("--crossing", loss_.crossing, 0, kLongest,
                      "loss that a crossing counts as if no sensor sees the two people while they "
                      "are within a metre of each other",
                      Enters::History);
    }
    [[nodiscard]] std::vector<std::shared_ptr<const Demand>> demandsIn(
        const SiteInput& site, std::span<const RoomGoals> /*goals*/, const ArrangeOptions& how,
        const CommonOptions& common, std::vector<std::string>& files) const override {
        LossRule loss = loss_;
        loss.plane = how.plane;
        const std::vector<presence::RoomPaths> ways =
            presence::waysIn(site, "--ways", ways_, common.seed, how.plane);
        std::vector<std::shared_ptr<const Demand>> demands;
        for (std::size_t i = 0; i < ways.size(); ++i) {
            MomentSampler sampler;
            if (!ways[i].isEmpty())
                presence::visitPaths(ways[i].choice, *site.rooms()[i], ways[i].seed,
                                     [&sampler](const std::string& id, double time, Point2 place) {
                                         sampler.add(id, time, place);
                                     });
            if (!ways_.record.empty()) {
                const RecordedFiles record(ways[i].choice.record);
                files.push_back(record.robots);
                if (!record.people.empty()) files.push_back(record.people);
            }
            demands.push_back(std::make_shared<TrackDemand>(sampler.finish(), loss));
        }
        return demands;
    }

  private:
    presence::PathsChoice ways_ = presence::parseWays("wander:4,10min");
    LossRule loss_ = {};
};

}  // namespace

std::unique_ptr<ObjectiveGroup> makeTrackObjective() { return std::make_unique<TrackObjective>(); }

}  // namespace ispace::tracking
