// SPDX-License-Identifier: GPL-3.0-or-later
// simrun over the storeys of a building.
#include "simrun/simrun_building.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "cli/building_operands.h"
#include "cli/outputs.h"
#include "passage/building_run.h"
#include "passage/building_script.h"
#include "scene/findings/findings.h"
#include "sim/world_state.h"
#include "simrun/simrun_ports.h"
#include "simrun/simrun_run.h"

namespace ispace {

namespace {

/// Options that are about one room.
void mustBeAboutBuildings(const SimrunOptions& options, const BuildingInput& input) {
    const auto refuse = [&](bool is_given, const std::string& option) {
        if (is_given)
            throw UsageError(option + " is about one room: choose a storey with --storey (" +
                             input.building.document.storeyList() + ')');
    };
    refuse(!options.zones.empty(), "--zone");
    refuse(!options.expected.empty(), "--expect");
    refuse(!options.report.empty(), "--report");
    refuse(!options.replay.empty(), "--replay");
    refuse(options.foxglove.has_value(), "--foxglove");
    refuse(options.rosbridge.has_value(), "--rosbridge");
    refuse(options.ros_domain.has_value(), "--ros2");
    refuse(options.mqtt.has_value(), "--mqtt");
    refuse(!options.load_folder.empty(), "--load");
    refuse(!options.devices.ports().empty(), "a port of a device");
}

void warnOfScenes(const SimrunOptions& options, const BuildingInput& input) {
    warn(options.common, "simrun", input.warnings);
    for (std::size_t i = 0; i < input.building.scenes.size(); ++i)
        for (Diagnostic finding :
             sceneWarnings(*input.building.scenes[i],
                           {.checks = {"unplaced", "outside", "buried", "paths"}})) {
            finding.message = input.building.document.storeys[i].id + ": " + finding.message;
            warn(options.common, "simrun", std::span<const Diagnostic>(&finding, 1));
        }
}

/// Records each room into a folder of its name, as a run by itself.
std::vector<std::unique_ptr<RunningRecord>> recordsOf(const SimrunOptions& options,
                                                      BuildingRun& run, const History& history,
                                                      Server& server) {
    std::vector<std::unique_ptr<RunningRecord>> records;
    if (options.record.empty()) return records;
    std::filesystem::create_directory(options.record);
    SimrunOptions own = options;
    for (std::size_t i = 0; i < run.rooms().size(); ++i) {
        const JoinedRoom& room = run.rooms()[i];
        own.record = options.record + '/' + room.id;
        records.push_back(recordOf(*room.simulation, own, room.simulation->world().scene(), history,
                                   options.noise, server.frameTaker(i)));
    }
    return records;
}

}  // namespace

bool runBuilding(const SimrunCommand& command) {
    const SimrunOptions& options = command.options();
    const auto input = readBuildingInput({options.operands, options.rules, false});
    if (!input) return false;
    mustBeAboutBuildings(options, *input);
    warnOfScenes(options, *input);
    BuildingRun run(input->building, {.step = options.step,
                                      .run = runOptionsOf(options, std::nullopt),
                                      .clock = options.clock,
                                      .until = options.until});
    Simulation& simulation = run.simulation();
    std::optional<BuildingScript> script;
    if (!options.script.empty()) {
        const bool is_stdin = options.script == "-";
        script.emplace(is_stdin ? readStdin() : readAll(options.script),
                       is_stdin ? displayName("-") : options.script, run);
        simulation.beforeStep([&] { script->give(run); });
    }
    std::vector<CollisionLog> collisions;
    for (const JoinedRoom& room : run.rooms())
        collisions.emplace_back(room.simulation->world(), options.common);
    LagLog lag(simulation, options.common);
    simulation.onStep([&] {
        lag.tell();
        for (CollisionLog& log : collisions) log.tell();
    });
    // Without a source: clients do not change the rooms of a building.
    Server server(simulation, options.listen, limitsOf(options), &run);
    ServedAddresses addresses;
    if (options.web)
        addresses.web = server.serveWeb(*options.web, baseName(input->environment_operand));
    const StopSignals signals;
    server.stopOn(signals.descriptor());
    std::optional<OutputFile> port_file;
    if (!options.port_file.empty()) {
        port_file.emplace(options.port_file);
        port_file->write(std::to_string(server.port()) + '\n');
    }
    History history = input->layout ? input->layout->history : History();
    history.push_back(command.historyLine(input->named));
    const auto records = recordsOf(options, run, history, server);
    const auto progress = progressOf(simulation, options);
    announce(server, addresses);
    if (port_file) port_file->commit();
    server.run();
    progress->end();
    for (std::size_t i = 0; i < records.size(); ++i)
        records[i]->recorder.end(run.rooms()[i].simulation->world());
    report(simulation, options);
    return true;
}

}  // namespace ispace
