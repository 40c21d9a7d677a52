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
#include "cli/scene_folder.h"
#include "passage/building_run.h"
#include "passage/building_script.h"
#include "record/text.h"
#include "scene/run/run_reader.h"
#include "sim/world_state.h"
#include "simrun/simrun_ports.h"
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

/// Records each room into a folder of its name, as a run by itself, and beside them the building
/// and its lifts.
std::vector<std::unique_ptr<RunningRecord>> recordsOf(const SimrunOptions& options,
                                                      BuildingRun& run,
                                                      const BuildingScene& building,
                                                      const History& history, Server& server) {
    std::vector<std::unique_ptr<RunningRecord>> records;
    if (options.record.empty()) return records;
    for (const JoinedRoom& room : run.rooms()) checkRecord(options, room.simulation->world());
    if (std::filesystem::exists(RecordedFiles(options.record).robots))
        throw UsageError("--record: " + options.record +
                         " holds the record of one room: give another folder");
    std::filesystem::create_directory(options.record);
    SimrunOptions own = options;
    for (std::size_t i = 0; i < run.rooms().size(); ++i) {
        const JoinedRoom& room = run.rooms()[i];
        const Replay* const replay = run.replay(i);
        own.record = options.record + '/' + room.id;
        records.push_back(recordOf(*room.simulation, own, room.simulation->world().scene(), history,
                                   replay != nullptr ? replay->hasOdometry() : options.noise,
                                   server.frameTaker(i)));
    }
    writeBuilding(building, history, options.record);
    run.recordLifts(options.record + '/' + BuildingRun::kLiftFile);
    return records;
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

/// What the worlds tell on stderr after a step.
class StepLogs {
  public:
    StepLogs(BuildingRun& run, const SimrunOptions& options)
        : lag_(run.simulation(), options.common) {
        for (std::size_t i = 0; i < run.rooms().size(); ++i)
            if (const Replay* const replay = run.replay(i)) {
                failures_.emplace_back(replay, options.common);
            } else {
                collisions_.emplace_back(run.world(i), options.common);
                unreached_.emplace_back(*run.rooms()[i].simulation, options.common);
            }
    }
    void tell() {
        lag_.tell();
        for (CollisionLog& log : collisions_) log.tell();
        for (UnreachedLog& log : unreached_) log.tell();
        for (FailureLog& log : failures_) log.tell();
    }

  private:
    std::vector<CollisionLog> collisions_;
    std::vector<UnreachedLog> unreached_;
    std::vector<FailureLog> failures_;
    LagLog lag_;
};

/// Reserves the files of all records.
void claimRecords(const SimrunOptions& options, const BuildingRun& run) {
    if (options.record.empty()) return;
    for (const JoinedRoom& room : run.rooms())
        for (const std::string& file : Recorder::filesIn(options.record + '/' + room.id))
            claimOutput(file, "a file of --record");
}

/// Writes --report and --suggest. \pre the records are complete
void reportRun(const SimrunOptions& options, const BuildingInput& input, const BuildingRun& run,
               const RunJudge& judge, const std::string& command) {
    if (options.report.empty() && !options.suggestions) return;
    for (const JoinedRoom& room : run.rooms())
        for (const std::string& file : Recorder::filesIn(options.record + '/' + room.id))
            completeOutput(file);
    if (!options.report.empty())
        writeAll(options.report, reportFile(options, input, judge, command));
    if (options.suggestions) writeAll("-", suggestionsText(options, input));
}

}  // namespace

bool runBuilding(const SimrunCommand& command, JunitFile& junit) {
    const SimrunOptions& options = command.options();
    auto input = readInput(options, recordedBuilding(options.replay));
    if (!input) return false;
    addZones(options.zones, input->building);
    warnOfScenes(options, *input);
    BuildingRun run = runOf(options, input->building);
    forward(run, options.from);
    Simulation& simulation = run.simulation();
    claimRecords(options, run);
    std::optional<BuildingScript> script;
    if (!options.script.empty()) {
        const bool is_stdin = options.script == "-";
        script.emplace(is_stdin ? readStdin() : readAll(options.script),
                       is_stdin ? displayName("-") : options.script, run);
        simulation.beforeStep([&] { script->give(run); });
    }
    StepLogs logs(run, options);
    simulation.onStep([&logs] { logs.tell(); });
    std::vector<RunRoom> rooms;
    rooms.reserve(run.rooms().size());
    for (const JoinedRoom& room : run.rooms()) rooms.push_back({room.id, room.simulation});
    const auto judge = options.judges->judge(rooms);
    judge->observe();
    simulation.onStep([&judge] { judge->observe(); });
    if (options.judges->isAsked()) simulation.keepOrder();
    ServerLimits limits = limitsOf(options);
    limits.source = std::make_shared<SceneFolder>(
        options.load_folder.empty()
            ? std::filesystem::path(input->environment_operand).parent_path().string()
            : options.load_folder,
        options.rules);
    Server server(simulation, options.listen, limits, &run);
    std::vector<std::string> replayed;
    if (!options.replay.empty())
        for (const JoinedRoom& room : run.rooms())
            replayed.push_back(options.replay + '/' + room.id);
    const ServedAddresses addresses =
        servePorts(server, options, baseName(input->environment_operand), replayed);
    std::optional<TopicLog> log;
    if (!options.mcap.empty()) log.emplace(server, simulation, options);
    const StopSignals signals;
    server.stopOn(signals.descriptor());
    std::optional<OutputFile> port_file;
    if (!options.port_file.empty()) {
        port_file.emplace(options.port_file);
        port_file->write(std::to_string(server.port()) + '\n');
    }
    History history = input->layout ? input->layout->history : History();
    history.push_back(command.historyLine(input->named));
    const auto records = recordsOf(options, run, input->building, history, server);
    const auto progress = progressOf(simulation, options);
    announce(server, addresses);
    if (port_file) port_file->commit();
    server.run();
    progress->end();
    for (std::size_t i = 0; i < records.size(); ++i)
        records[i]->recorder.end(run.rooms()[i].simulation->world());
    if (log) log->commit();
    tellLosses(server, options);
    report(simulation, options);
    for (std::size_t i = 0; i < run.rooms().size(); ++i)
        if (run.replay(i) != nullptr && run.replay(i)->isCut())
            warn(options.common, "simrun",
                 run.rooms()[i].id + ": the record ends in the midst of a step, which is left out");
    reportRun(options, *input, run, *judge, history.back());
    judge->report(options.record);
    conclude(*judge, options, input->environment_operand, junit);
    return true;
}

}  // namespace ispace
