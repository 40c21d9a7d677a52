// SPDX-License-Identifier: GPL-3.0-or-later
// simrun: simulates the robots and sensors of a scene and serves them over TCP.
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/json_writer.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/run_tool.h"
#include "cli/scene_folder.h"
#include "net/server.h"
#include "net/token.h"
#include "simrun/drawing.h"
#include "simrun/options.h"
#include "simrun/record.h"
#include "simrun/warnings.h"

namespace {

using namespace ispace;

/// The first line of output: clients can connect now.
void announce(const Server& server, const std::string& web) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-simrun/1");
    json.key("listen").value(server.address());
    json.key("p2os").beginObject().endObject();
    json.key("scip").beginObject().endObject();
    if (!web.empty()) json.key("web").value(web);
    json.endObject();
    writeAll("-", json.take() + '\n');
    // Clients are not cut off because nobody reads the warnings any more.
    std::signal(SIGPIPE, SIG_IGN);
}

/// A client takes a file descriptor: as many as this process may have, less what it needs itself.
ServerLimits withinFileLimit(ServerLimits limits) {
    constexpr rlim_t kOwn = 32;
    rlimit files{};
    if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return limits;
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
    const rlim_t most = files.rlim_cur > kOwn ? files.rlim_cur - kOwn : 1;
    limits.clients = static_cast<std::size_t>(std::min<rlim_t>(limits.clients, most));
    return limits;
}

/// Limits of the server, with what clients need to know and may read.
ServerLimits limitsOf(const SimrunOptions& options, const SceneInput& input) {
    ServerLimits limits = withinFileLimit(options.limits);
    if (!options.token_file.empty()) {
        limits.token = readToken(options.token_file);
        if (isOpenToOthers(options.token_file))
            warn(options.common, "simrun",
                 options.token_file + " can be read by other users: chmod 600 makes it yours");
    }
    const std::string& folder = options.load_folder;
    limits.source = std::make_shared<SceneFolder>(folder.empty() ? SceneFolder::of(input) : folder,
                                                  options.any_environment);
    return limits;
}

std::vector<TimedCommand> scriptOf(const SimrunOptions& options, const SceneInput& input,
                                   const World& world) {
    if (options.script.empty()) return {};
    if (options.script == "-") {
        if (input.environment_operand == "-" || input.layout_operand == "-")
            throw UsageError("stdin cannot be read twice: give the script or the scene as a file");
        return readScript(readStdin(), displayName("-"), world);
    }
    return readScript(readAll(options.script), options.script, world);
}

std::unique_ptr<Progress> progressOf(Simulation& simulation, const SimrunOptions& options) {
    if (!options.until) return std::make_unique<SilentProgress>();
    auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    progress->begin("steps", (*options.until + options.step - SimTime(1)) / options.step);
    simulation.onStep([bar = progress.get()] { bar->advance(1); });
    return progress;
}

void report(const Simulation& simulation, const SimrunOptions& options) {
    const World& world = simulation.world();
    talk(options.common, "simrun",
         std::to_string(world.steps()) + " steps, t=" + formatSimTime(world.time()));
    if (const auto& [steps, late, most] = simulation.lateness(); steps > 0)
        talk(options.common, "simrun",
             std::to_string(late) + " of " + std::to_string(steps) +
                 " steps began more than a step late, the latest by " + formatMilliseconds(most) +
                 " s");
    if (const SimTime lost = simulation.lost(); lost > SimTime(0))
        talk(options.common, "simrun",
             "the world could not keep up: the clock gave up " + formatMilliseconds(lost) + " s");
}

/// The last word on a run: what it was expected to do.
void conclude(const ExpectationJudge& judge, const SimrunOptions& options, const SceneInput& input,
              std::optional<OutputFile>& junit) {
    const std::vector<RunVerdict> verdicts = judge.verdicts();
    if (junit) {
        junit->write(junitXml(verdicts, baseName(input.environment_operand)));
        junit->commit();
    }
    if (const std::string unmet = unmetText(verdicts); !unmet.empty()) throw UnmetError(unmet);
    if (!verdicts.empty())
        talk(options.common, "simrun", "all " + std::to_string(verdicts.size()) + " met");
}

/// A record knows its scene.
SceneInput readInput(const SimrunOptions& options) {
    std::vector<std::string> operands = options.operands;
    if (!options.replay.empty() && operands.empty()) {
        const std::string scene = RecordedFiles(options.replay).scene;
        if (!std::filesystem::exists(scene))
            throw UsageError(options.replay +
                             " holds no scene.env: give ENV and LAYOUT of the run");
        operands.push_back(scene);
    }
    return readScene({operands, options.any_environment, false});
}

/// Of what is shown: the room, or the record.
std::string titleOf(const SimrunOptions& options, const SceneInput& input) {
    const std::string& shown = options.replay.empty() ? input.environment_operand : options.replay;
    return shown == "-" ? "" : baseName(shown);
}

/// The record to be served, and the scene as it begins; nothing without --replay.
std::optional<Replay> openReplay(const SimrunOptions& options, Scene& scene) {
    if (options.replay.empty()) return std::nullopt;
    Replay replay(options.replay);
    replay.placeAtStart(scene);
    return replay;
}

/// Up to where a record is to be served from.
void forward(Replay& replay, World& world, SimTime from) {
    while (world.time() < from)
        if (!replay.step(world))
            throw UsageError("--from: the record ends at t=" + formatSimTime(world.time()));
}

History historyOf(const SimrunCommand& command, const SceneInput& input) {
    History history = input.layout ? input.layout->history : History();
    history.push_back(command.historyLine(input.named));
    return history;
}

void simrun(const SimrunCommand& command) {
    const SimrunOptions& options = command.options();
    limitThreads(options.common.threads);
    if (!options.drawing.format.empty()) claimOutputs(options.common);
    claimOutput(options.port_file, "--port-file");
    claimOutput(options.junit, "--junit");
    if (!options.record.empty())
        for (const std::string& file : Recorder::filesIn(options.record))
            claimOutput(file, "a file of --record");
    SceneInput input = readInput(options);
    warn(options.common, "simrun", input.environment.warnings);
    warnOfLeftOut(input.scene, options.common);
    warnOfOutside(input.scene, options.common);
    std::optional<Replay> replay = openReplay(options, input.scene);
    if (!options.drawing.format.empty())
        return drawRecord(options, input.scene, titleOf(options, input));
    const bool noise = options.noise && !replay;
    if (noise) warnOfNoNoise(input.scene, options.common);
    World world(input.scene, replay ? replay->stepLength() : options.step,
                {.seed = options.common.seed, .noise = noise});
    if (replay) warnOfChanges(*replay, options.common);
    if (replay) forward(*replay, world, options.from);
    Simulation simulation(world, scriptOf(options, input, world), options.clock, options.until);
    if (replay) simulation.replay(*replay, options.holds);
    CollisionLog collisions(world, options.common);
    if (!replay) simulation.onStep([&collisions] { collisions.tell(); });
    auto judge = ofOption("--expect", [&] { return ExpectationJudge(world, options.expected); });
    judge.observe();
    simulation.onStep([&judge] { judge.observe(); });

    checkRecord(options, world);
    Server server(simulation, options.listen, limitsOf(options, input));
    const std::string web =
        options.web ? server.serveWeb(*options.web, titleOf(options, input)) : "";
    const StopSignals signals;
    server.stopOn(signals.descriptor());
    std::optional<OutputFile> port_file;
    if (!options.port_file.empty()) {
        port_file.emplace(options.port_file);
        port_file->write(std::to_string(server.port()) + '\n');
    }
    // Before the run, so that none is lost for want of a folder.
    std::optional<OutputFile> junit;
    if (!options.junit.empty()) junit.emplace(options.junit);
    const auto record = recordOf(simulation, options, input.scene, historyOf(command, input));
    const auto progress = progressOf(simulation, options);
    announce(server, web);
    if (port_file) port_file->commit();
    server.run();
    progress->end();
    if (record) record->recorder.flush(world);
    report(simulation, options);
    if (replay && replay->isCut())
        warn(options.common, "simrun", "the record ends in the midst of a step, which is left out");
    conclude(judge, options, input, junit);
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("simrun", [&] { simrun(ispace::SimrunCommand(argc, argv)); });
}
