// SPDX-License-Identifier: GPL-3.0-or-later
// simrun: simulates the robots and sensors of a scene and serves them over TCP.
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "base/file.h"
#include "base/run_files.h"
#include "cli/job_server.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "scene/findings/findings.h"
#include "server/server.h"
#include "sim/world_state.h"
#include "simrun/simrun_building.h"
#include "simrun/simrun_options.h"
#include "simrun/simrun_ports.h"
#include "simrun/simrun_report.h"
#include "simrun/simrun_run.h"
#include "tools.h"

namespace {

using namespace ispace;

/// Reports before the run which outputs cannot be written.
void claimFiles(const SimrunOptions& options) {
    if (!options.drawing.format.empty()) claimOutputs(options.common);
    claimOutput(options.port_file, "--port-file");
    claimOutput(options.junit, "--junit");
    options.judges->claim();
    claimOutput(options.report, "--report");
    claimOutput(mcapFile(options), "--mcap");
    claimOutput(bagMetadataFile(options), "the metadata of --mcap");
    if (options.record.empty()) return;
    for (const std::string& file : Recorder::filesIn(options.record))
        claimOutput(file, "a file of --record");
}

/// Runs it. If other threads are still at work at the end, the process exits at once, with the same
/// status and lines: they use objects that would be destroyed, and a picture or a large room may
/// take minutes.
void endingAtOnce(const std::function<bool()>& is_busy, JunitFile& junit,
                  const SimrunOptions& options, const std::function<void()>& work) {
    std::exception_ptr failure;
    try {
        work();
    } catch (...) {
        failure = std::current_exception();
    }
    const auto end = [&failure] {
        if (failure) std::rethrow_exception(failure);
    };
    if (is_busy()) std::_Exit(runTool("simrun", [&] { junit.during(options.operands, end); }));
    end();
}

void serve(Simulation& simulation, const SimrunCommand& command, const SceneInput& input,
           const std::optional<Replay>& replay, JunitFile& junit) {
    const SimrunOptions& options = command.options();
    World& world = simulation.world();
    const RunRoom room{"", &simulation};
    const auto judge = options.judges->judge({&room, 1});
    judge->observe();
    simulation.onStep([&judge] { judge->observe(); });
    if (options.judges->isAsked()) simulation.keepOrder();

    checkRecord(options, world);
    Server server(simulation, options.listen, limitsOf(options, input));
    const ServedAddresses addresses =
        servePorts(server, options, titleOf(options, input),
                   replay ? std::vector<std::string>{options.replay} : std::vector<std::string>());
    std::optional<TopicLog> log;
    if (!options.mcap.empty()) log.emplace(server, simulation, options);
    const StopSignals signals;
    server.stopOn(signals.descriptor());
    std::optional<OutputFile> port_file;
    if (!options.port_file.empty()) {
        port_file.emplace(options.port_file);
        port_file->write(std::to_string(server.port()) + '\n');
    }
    const bool odometry = replay ? replay->hasOdometry() : options.noise;
    const auto record = recordOf(simulation, options, input.scene, historyOf(command, input),
                                 odometry, server.frameTaker());
    const auto progress = progressOf(simulation, options);
    announce(server, addresses);
    if (port_file) port_file->commit();
    const auto serve_and_conclude = [&] {
        server.run();
        progress->end();
        if (record) record->recorder.end(world);
        if (log) log->commit();
        tellLosses(server, options);
        report(simulation, options);
        if (replay && replay->isCut())
            warn(options.common, "simrun",
                 "the record ends in the midst of a step, which is left out");
        if (!options.report.empty())
            writeAll(options.report,
                     reportFile(options, input, *judge, historyOf(command, input).back()));
        if (options.suggestions) writeAll("-", suggestionsText(options, input));
        judge->report(options.record);
        conclude(*judge, options, input.environment_operand, junit);
    };
    endingAtOnce([&server] { return server.isBusy(); }, junit, options, serve_and_conclude);
}

void run(const SimrunCommand& command, JunitFile& junit) {
    const SimrunOptions& options = command.options();
    SceneInput input = readInput(options);
    warnOfImport(options.common, "simrun", input);
    warn(options.common, "simrun",
         sceneWarnings(input.scene, {.checks = {"unplaced", "outside", "buried", "paths"}}));
    std::optional<Replay> replay = openReplay(options, input.scene);
    if (!replay) warnOfTrips(input.scene, options.common);
    if (!options.drawing.format.empty() && replay) warnOfChanges(*replay, options.common);
    if (!options.drawing.format.empty())
        return drawRecord(options, input.scene, titleOf(options, input));
    if (options.noise && !hasNoise(input.scene, !replay)) warnOfNoNoise(options.common);
    World world(input.scene, replay ? replay->stepLength() : options.step,
                runOptionsOf(options, replay ? std::optional(replay->info()) : std::nullopt));
    warn(options.common, "simrun", startWarnings(world));
    if (replay) forward(*replay, world, options.from);
    Script script = scriptOf(options, input, world);
    Simulation simulation(world, std::move(script.commands), options.clock, options.until);
    simulation.follow(std::move(script.days));
    if (replay) simulation.replay(*replay, options.holds);
    CollisionLog collisions(world, options.common);
    UnreachedLog unreached(simulation, options.common);
    FailureLog failures(replay ? &*replay : nullptr, options.common);
    LagLog lag(simulation, options.common);
    simulation.onStep([&lag] { lag.tell(); });
    if (replay)
        simulation.onStep([&failures] { failures.tell(); });
    else
        simulation.onStep([&] {
            collisions.tell();
            unreached.tell();
        });
    serve(simulation, command, input, replay, junit);
}

void simrun(const SimrunCommand& command) {
    const SimrunOptions& options = command.options();
    limitThreads(options.common.threads);
    if (options.task) return options.task();
    claimFiles(options);
    JunitFile junit("simrun", options.junit);
    junit.during(options.operands, [&] {
        if (!options.drawing.format.empty() || !runBuilding(command, junit)) run(command, junit);
    });
}

}  // namespace

int ispace::runSimrun(int argc, char** argv) {
    return runTool("simrun", argc, argv,
                   [](int count, char** words) { simrun(ispace::SimrunCommand(count, words)); });
}
