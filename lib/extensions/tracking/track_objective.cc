// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/tracking/track_objective.h"

#include "arrange/arrange.h"
#include "cli/presence_ways.h"
#include "extensions/tracking/track_demand.h"
#include "scene/run/run_reader.h"

namespace ispace {

namespace {

class TrackObjective : public ObjectiveGroup {
  public:
    [[nodiscard]] std::string_view word() const override { return "track"; }
    [[nodiscard]] std::string_view help() const override {
        return "the time for which a tracker follows people, and crossings that are seen";
    }
    void declare(CommandLine& line) override {
        constexpr double kLongest = 3600;
        line.group("Goals of trackers");
        line.parsed(
            "--ways", "DIR|wander:N[,TIME]",
            [this](const std::string& text) { ways_ = parseWays(text); },
            "people to track: those of the run that simrun --record wrote to DIR, or N wanderers "
            "for TIME (default wander:4,10min)",
            Enters::BaseNames);
        line.duration("--coast", loss_.coast, 0, kLongest,
                      "time for which a tracker follows an unseen person (default 1s)",
                      Enters::History);
        line.duration("--crossing", loss_.crossing, 0, kLongest,
                      "loss that a crossing counts as if no sensor sees the two people while they "
                      "are within a metre of each other (default 5s)",
                      Enters::History);
    }
    [[nodiscard]] std::shared_ptr<const Demand> demandIn(
        const Scene& scene, const ArrangeOptions& how, const CommonOptions& common,
        std::vector<std::string>& files) const override {
        MomentSampler sampler;
        visitWays(ways_, scene, common.seed,
                  [&sampler](const std::string& id, double time, Point2 place) {
                      sampler.add(id, time, place);
                  });
        if (!ways_.record.empty()) {
            const RecordedFiles record(ways_.record);
            files.push_back(record.robots);
            if (!record.people.empty()) files.push_back(record.people);
        }
        LossRule loss = loss_;
        loss.plane = how.plane;
        return std::make_shared<TrackDemand>(sampler.finish(), loss);
    }

  private:
    WaysChoice ways_ = parseWays("wander:4,10min");
    LossRule loss_ = {};
};

}  // namespace

std::unique_ptr<ObjectiveGroup> makeTrackObjective() { return std::make_unique<TrackObjective>(); }

}  // namespace ispace
