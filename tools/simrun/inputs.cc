// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/inputs.h"

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "cli/recorded_changes.h"

namespace ispace {

SceneInput readInput(const SimrunOptions& options) {
    std::vector<std::string> operands = options.operands;
    if (!options.replay.empty() && operands.empty()) {
        const std::string scene = sceneOfRecord(options.replay);
        if (scene.empty())
            throw UsageError(options.replay +
                             " holds no scene.env: give ENV and LAYOUT of the run");
        operands.push_back(scene);
    }
    SceneInput input = readScene({operands, options.rules, false});
    addZones(options.zones, input);
    return input;
}

std::string titleOf(const SimrunOptions& options, const SceneInput& input) {
    const std::string& shown = options.replay.empty() ? input.environment_operand : options.replay;
    return shown == "-" ? "" : baseName(shown);
}

std::optional<Replay> openReplay(const SimrunOptions& options, Scene& scene) {
    if (options.replay.empty()) return std::nullopt;
    Replay replay(options.replay);
    if (replay.changedAt()) replay.makeChanges(changesOfRun(options.replay, scene));
    replay.placeAtStart(scene);
    return replay;
}

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

RunOptions runOptionsOf(const SimrunOptions& options, const std::optional<Replay>& replay) {
    if (replay && !options.noise)
        return {.seed = replay->info().seed, .sensor_noise = replay->info().noise};
    if (replay) return {.seed = options.common.seed, .sensor_noise = true};
    return {.seed = options.common.seed, .noise = options.noise, .sensor_noise = options.noise};
}

}  // namespace ispace
