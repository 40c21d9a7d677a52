// SPDX-License-Identifier: GPL-3.0-or-later
// simrun over the storeys of a building.
#include "simrun/simrun_building.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "cli/building_runs.h"
#include "cli/outputs.h"
#include "cli/storey_operands.h"
#include "extensions.h"
#include "record/text.h"
#include "scene/run/run_reader.h"
#include "sim/world_state.h"
#include "simrun/simrun_run.h"

namespace ispace {

namespace {

/// Writes the building with its layout. Storeys keep sharing rooms.
void writeBuilding(const SiteScene& building, const History& history, const std::string& folder) {
    StoreyedDocument whole = building.document;
    whole.history = history;
    std::map<const Scene*, std::shared_ptr<const Document>> rooms;
    for (std::size_t i = 0; i < whole.storeys.size(); ++i) {
        std::shared_ptr<const Document>& known = rooms[building.scenes[i].get()];
        if (!known) {
            auto room = std::make_shared<Document>(*whole.storeys[i].room);
            room->records = building.scenes[i]->records;
            rebaseFiles(room->records, "", folder);
            known = std::move(room);
        }
        whole.storeys[i].room = known;
    }
    writeAll(folder + '/' + kRecordedBuilding, writeBuildingYaml(whole));
}

/// \throws UsageError if the build lacks runs of buildings
std::unique_ptr<BuildingWorlds> worldsOf(const SimrunOptions& options, const SiteScene& building) {
    const BuildingRuns& runs = extensions().buildings();
    if (runs.open == nullptr)
        throw UsageError("the run of a building belongs to the extension " +
                         std::string(runs.extension) +
                         ", which this build lacks: --storey ID runs one of its storeys");
    std::optional<RunInfo> recorded;
    if (!options.replay.empty()) recorded = recordedInfo(options.replay, building.document);
    return runs.open(building, {.step = recorded ? recordedTime(recorded->every) : options.step,
                                .run = runOptionsOf(options, recorded),
                                .clock = options.clock,
                                .until = options.until,
                                .replay = options.replay,
                                .holds = options.holds,
                                .changes = [max_work = options.rules.max_work](
                                               const std::string& folder, const Scene& start) {
                                    return changesOfRun(folder, start, max_work);
                                }});
}

/// Moves a replay to the time from which it is served.
void forward(Simulation& simulation, SimTime from) {
    const SimTime step = simulation.world().stepLength();
    const SimTime first = (from + step - SimTime(1)) / step * step;
    if (first > SimTime(0)) simulation.seek(first);
    if (simulation.world().time() < first)
        throw UsageError("--from: the record ends at t=" +
                         formatSimTime(simulation.world().time()));
}

/// The run of all storeys, of the cabins of lifts, and of flights of stairs.
class BuildingRunSite final : public RunSite {
  public:
    BuildingRunSite(const SimrunCommand& command, SiteInput building)
        : RunSite(command, std::move(building)), worlds_(worldsOf(options, input.building)) {
        forward(*worlds_->rooms().front().simulation, options.from);
        claimRecords();
        if (!options.script.empty())
            worlds_->follow(scriptText(options, input), displayName(options.script));
    }

    Worlds& worlds() override { return *worlds_; }
    [[nodiscard]] const Replay* replay(std::size_t room) const override {
        return worlds_->replay(room);
    }
    void recordWhole() override {
        writeBuilding(input.building, history, options.record);
        worlds_->recordLifts(options.record);
    }

  private:
    void claimRecords() const {
        if (options.record.empty()) return;
        if (std::filesystem::exists(RecordedFiles(options.record).robots))
            throw UsageError("--record: " + options.record +
                             " holds the record of one room: give another folder");
        for (const RunRoom& room : worlds_->rooms())
            for (const std::string& file : Recorder::filesIn(folderOf(options.record, room)))
                claimOutput(file, "a file of --record");
    }

    const std::unique_ptr<BuildingWorlds> worlds_;
};

}  // namespace

std::unique_ptr<RunSite> openBuilding(const SimrunCommand& command, SiteInput building) {
    return std::make_unique<BuildingRunSite>(command, std::move(building));
}

}  // namespace ispace
