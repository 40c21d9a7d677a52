// SPDX-License-Identifier: GPL-3.0-or-later
#include "envc/options.h"

#include <algorithm>

#include "base/error.h"
#include "cli/scene_options.h"

namespace ispace {

EnvcOptions parseEnvcOptions(int argc, const char* const* argv) {
    EnvcOptions options;
    std::string to;
    CommandLine line("envc", "[INPUT]...",
                     "Compile a room (.env, .yaml, .glb, ROS map.yaml) and layouts (.3dm) into one "
                     "model; without INPUT, or for -, read stdin.");
    line.operands(options.inputs, 1000);
    line.choice("--to", to, {"glb", "env", "3dm"},
                "format of the model (default: suffix of FILE, else glb)", Enters::History);
    line.meters("--wall-height", options.import.wall_height, 0.001, 1000,
                "height of walls of imported maps", Enters::History);
    line.meters("--simplify", options.import.simplify, 0, 1000,
                "outlines of imported maps may move by this (default: one cell)", Enters::History);
    line.flag("--info", options.info, "report on the environment instead of writing it",
              Enters::Nothing);
    line.flag("--json", options.json, "the report of --info as JSON", Enters::Nothing);
    addAnyEnvironmentOption(line, options.any_environment);
    addCommonOptions(line, options.common, "write the model there (default: stdout)");
    line.parse(argc, argv);

    if (options.inputs.empty()) options.inputs.emplace_back("-");
    if (std::count(options.inputs.begin(), options.inputs.end(), "-") > 1)
        throw UsageError("stdin cannot be read twice: only one operand can be -");
    if (options.json && !options.info) throw UsageError("--json is the form of --info: give both");
    if (!options.info)
        options.format = outputFormat(to, options.common.output, {"glb", "env", "3dm"});
    options.history_line = line.historyLine(options.inputs);
    return options;
}

}  // namespace ispace
