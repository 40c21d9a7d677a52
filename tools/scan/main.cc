// SPDX-License-Identifier: GPL-3.0-or-later
// scan: simulates what the sensors of a scene read.
#include "base/error.h"
#include "base/file.h"
#include "cli/dependencies.h"
#include "cli/operands.h"
#include "cli/run_tool.h"
#include "scan/options.h"
#include "sense/scan_jsonl.h"

namespace {

using namespace ispace;

void scan(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    const ThreadLimit threads(options.common.threads);
    const SceneInput input = readScene({options.operands, options.any_environment, true});
    const Scene& scene = input.scene;
    if (scene.lasers.empty())
        throw FormatError({displayName(input.layout_operand), 0, 0,
                           "no placed sensor: give one `at=x,y`, or let arrange place it"});
    Worlds worlds(scene.environment);
    const MovingBodies bodies(robotBodies(scene.robots));
    const std::vector<Scan> scans = castScans(worlds, scene.lasers, bodies);

    History history = input.layout ? input.layout->history : History();
    history.push_back(command.historyLine(input.named));
    OutputFile output(options.common.output);
    std::string text = scanHeaderLine(history, options.common.seed);
    for (std::size_t i = 0; i < scans.size(); ++i) {
        appendScanLine(text, scene.lasers[i], scans[i]);
        output.write(text);
        text.clear();
    }
    output.commit();
    writeDependencies(options.common, filesOf(input));
    talk(options.common, "scan", std::to_string(scans.size()) + " scans written");
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("scan", [&] { scan(ispace::ScanCommand(argc, argv)); });
}
