// SPDX-License-Identifier: GPL-3.0-or-later
// coverage: measures and draws what the sensors of a scene see.
#include <iostream>

#include "base/error.h"
#include "base/file.h"
#include "base/history.h"
#include "base/number.h"
#include "cli/dependencies.h"
#include "cli/operands.h"
#include "cli/run_tool.h"
#include "coverage/options.h"

namespace {

using namespace ispace;

void checkRequired(const CoverageToolOptions& options, const CoverageReport& report) {
    const double share = report.coverage.grid.value_or(0);
    if (!options.require || share >= *options.require) return;
    throw UnmetError("coverage is " + formatFixed(share * 100, 2) + "%, below the required " +
                     options.require_text);
}

/// Figures are of lasers alone in this version.
void warnOfOthers(const Scene& scene, bool quiet) {
    const std::size_t others = scene.rangers.size() + scene.receivers.size();
    if (others == 0 || quiet) return;
    std::cerr << "coverage: warning: " << others
              << (others == 1 ? " sensor that is no laser is" : " sensors that are no lasers are")
              << " not measured\n";
}

void coverage(CoverageToolOptions options) {
    const ThreadLimit threads(options.common.threads);
    const SceneInput input = readScene({options.operands, options.any_environment, true});
    warnOfOthers(input.scene, options.common.quiet);
    Worlds worlds(input.scene.environment);
    const Coverage measured =
        measureCoverage(input.scene, worlds, options.columns, options.rows, options.height);
    if (options.draw) {
        options.map.title =
            input.environment_operand == "-" ? "" : baseName(input.environment_operand);
        writeAll(options.common.output, drawCoverageMap(input.scene, measured, options.map));
        writeDependencies(options.common, filesOf(input));
    }
    writeAll("-", options.json ? coverageJson(measured.report) : coverageText(measured.report));
    talk(options.common, "coverage",
         std::to_string(measured.seen.size()) + " sensors measured on " +
             std::to_string(measured.target.grid.size()) + " cells");
    checkRequired(options, measured.report);
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("coverage", [&] { coverage(ispace::parseCoverageOptions(argc, argv)); });
}
