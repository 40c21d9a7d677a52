// SPDX-License-Identifier: GPL-3.0-or-later
// simrun: simulates the robots and sensors of a scene and serves them over TCP.
#include <string>

#include "base/file.h"
#include "base/run_files.h"
#include "cli/job_server.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "sim/recorder.h"
#include "simrun/simrun_options.h"
#include "simrun/simrun_ports.h"
#include "simrun/simrun_run.h"
#include "tools.h"

namespace {

using namespace ispace;

/// Reports before the run which outputs cannot be written.
void claimFiles(const SimrunOptions& options) {
    if (options.drawing) claimOutputs(options.common);
    claimOutput(options.port_file, "--port-file");
    claimOutput(options.junit, "--junit");
    options.judges->claim();
    claimOutput(options.report, "--report");
    options.bridges->claim();
    if (options.record.empty()) return;
    for (const std::string& file : Recorder::filesIn(options.record))
        claimOutput(file, "a file of --record");
}

void simrun(const SimrunCommand& command) {
    const SimrunOptions& options = command.options();
    limitThreads(options.common.threads);
    if (options.task) return options.task();
    claimFiles(options);
    JunitFile junit("simrun", options.junit);
    junit.during(options.operands, [&] {
        if (options.drawing) return drawRecord(options);
        serve(*openSite(command), options, junit);
    });
}

}  // namespace

int ispace::runSimrun(int argc, char** argv) {
    return runTool("simrun", argc, argv,
                   [](int count, char** words) { simrun(ispace::SimrunCommand(count, words)); });
}
