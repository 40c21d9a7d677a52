// SPDX-License-Identifier: GPL-3.0-or-later
// arrange: places sensors in a room and writes the layout.
#include "arrange/options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/dependencies.h"
#include "cli/operands.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "layout/schemas.h"
#include "layout/sensor_spec.h"
#include "record/text.h"

namespace {

using namespace ispace;

void report(const ArrangeToolOptions& options, const Arrangement& arrangement) {
    talk(options.common, "arrange",
         std::to_string(arrangement.placed.size()) + " placed, coverage " +
             formatFixed(arrangement.coverage * 100, 2) + " %, at most " +
             formatFixed(arrangement.bound * 100, 2) + " % with these candidates on this grid");
}

void arrange(const ArrangeCommand& command) {
    const ArrangeToolOptions& options = command.options();
    const ThreadLimit threads(options.common.threads);
    const DeviceCatalogue devices = DeviceCatalogue::load(shareFolder() + "/devices");
    std::vector<Record> added;
    for (const std::string& spec : options.sensors)
        for (Record& record : readSensorSpec(spec, kArrangedKinds, sceneSchemas(), devices))
            added.push_back(std::move(record));
    const SceneInput input = readScene({options.operands, options.any_environment, false});
    const std::vector<PendingLaser> sensors = sensorsToPlace(input.scene, added, devices);
    if (sensors.empty())
        throw UsageError("nothing to place: give --sensor, or a LAYOUT with a sensor without `at`");

    const auto progress = makeProgress("arrange", options.common.progress, options.common.quiet);
    const Arrangement arrangement = arrangeOnGrid(input.scene, sensors, options.search, *progress);

    LayoutParts parts{input.layout ? input.layout->history : History(),
                      environmentFileFor(options.common.output, input.environment_operand),
                      input.scene.digest, options.strategy};
    parts.history.push_back(command.historyLine(input.named));
    const Document layout =
        layoutDocument(parts, input.layout ? &*input.layout : nullptr, sensors, arrangement);
    writeAll(options.common.output, writeRecordText(layout));
    writeDependencies(options.common, filesOf(input));
    report(options, arrangement);
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("arrange", [&] { arrange(ispace::ArrangeCommand(argc, argv)); });
}
