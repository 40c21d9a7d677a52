// SPDX-License-Identifier: GPL-3.0-or-later
// simrun over the storeys of a building.
#include "simrun/simrun_building.h"

#include <algorithm>
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
#include "building/coupling.h"
#include "cli/building_operands.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "passage/building_run.h"
#include "passage/building_script.h"
#include "record/text.h"
#include "scene/run/run_reader.h"
#include "sim/world_state.h"
#include "simrun/simrun_report.h"
#include "simrun/simrun_run.h"

namespace ispace {

namespace {

void warnOfScenes(const SimrunOptions& options, const BuildingInput& input) {
    warnOfImport(options.common, "simrun", input);
    warn(options.common, "simrun",
         storeyWarnings(Coupling(input.building),
                        {.checks = {"unplaced", "outside", "buried", "paths"}}));
    const auto& scenes = input.building.scenes;
    if (options.noise && std::none_of(scenes.begin(), scenes.end(), [&](const auto& scene) {
            return hasNoise(*scene, options.replay.empty());
        }))
        warnOfNoNoise(options.common);
}

/// Writes the building with its layout. Storeys keep sharing rooms.
void writeBuilding(const BuildingScene& building, const History& history,
                   const std::string& folder) {
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

std::optional<BuildingInput> readInput(const SimrunOptions& options, const std::string& record) {
    std::vector<std::string> operands = options.operands;
    if (operands.empty() && !record.empty()) operands.push_back(record);
    auto input = readBuildingInput({operands, options.rules, false});
    if (input && record.empty() && !options.replay.empty())
        throw UsageError("--replay: " + options.replay +
                         " is the record of one room: choose its storey with --storey (" +
                         input->building.document.storeyList() + ')');
    return input;
}

BuildingRun runOf(const SimrunOptions& options, const BuildingScene& building) {
    std::optional<RunInfo> recorded;
    if (!options.replay.empty()) recorded = recordedInfo(options.replay, building.document);
    return BuildingRun(building, {.step = recorded ? recordedTime(recorded->every) : options.step,
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
void forward(BuildingRun& run, SimTime from) {
    Simulation& simulation = run.simulation();
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
    BuildingRunSite(const SimrunCommand& command, BuildingInput the_building)
        : RunSite(runInputOf(command, the_building)),
          options_(&command.options()),
          building_(std::move(the_building)),
          run_(runOf(*options_, building_.building)) {
        forward(run_, options_->from);
        claimRecords();
        if (options_->script.empty()) return;
        const bool is_stdin = options_->script == "-";
        script_.emplace(is_stdin ? readStdin() : readAll(options_->script),
                        is_stdin ? displayName("-") : options_->script, run_);
        run_.simulation().beforeStep([this] { script_->give(run_); });
    }

    JoinedWorlds& worlds() override { return run_; }
    [[nodiscard]] const Replay* replay(std::size_t room) const override {
        return run_.replay(room);
    }
    void recordWhole() override {
        writeBuilding(building_.building, input.history, options_->record);
        run_.recordLifts(options_->record + '/' + BuildingRun::kLiftFile);
    }
    [[nodiscard]] std::string report(const RunJudge& judge) const override {
        completeRecords();
        return reportFile(*options_, building_, judge, input.history.back());
    }
    [[nodiscard]] std::string suggestions() const override {
        completeRecords();
        return suggestionsText(*options_, building_);
    }

  private:
    static RunInput runInputOf(const SimrunCommand& command, const BuildingInput& building) {
        const std::string& operand = building.environment_operand;
        History history = building.layout ? building.layout->history : History();
        history.push_back(command.historyLine(building.named));
        return {operand, baseName(operand), std::filesystem::path(operand).parent_path().string(),
                std::move(history)};
    }
    [[nodiscard]] std::vector<std::string> recordFiles() const {
        std::vector<std::string> files;
        for (const JoinedRoom& room : run_.rooms())
            for (std::string& file : Recorder::filesIn(folderOf(options_->record, room)))
                files.push_back(std::move(file));
        return files;
    }
    void claimRecords() const {
        if (options_->record.empty()) return;
        if (std::filesystem::exists(RecordedFiles(options_->record).robots))
            throw UsageError("--record: " + options_->record +
                             " holds the record of one room: give another folder");
        for (const std::string& file : recordFiles()) claimOutput(file, "a file of --record");
    }
    void completeRecords() const {
        for (const std::string& file : recordFiles()) completeOutput(file);
    }

    const SimrunOptions* options_;
    BuildingInput building_;
    BuildingRun run_;
    std::optional<BuildingScript> script_;
};

}  // namespace

std::unique_ptr<RunSite> openBuilding(const SimrunCommand& command) {
    const SimrunOptions& options = command.options();
    auto input = readInput(options, recordedBuilding(options.replay));
    if (!input) {
        if (holdsBuilding(options.record))
            throw UsageError("--record: " + options.record +
                             " holds the record of a building: give another folder");
        return nullptr;
    }
    addZones(options.zones, input->building);
    warnOfScenes(options, *input);
    return std::make_unique<BuildingRunSite>(command, std::move(*input));
}

}  // namespace ispace
