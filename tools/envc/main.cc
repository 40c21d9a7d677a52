// SPDX-License-Identifier: GPL-3.0-or-later
// envc: compiles rooms, buildings and layouts into a model, checks, converts, edits and draws them.
#include <string>

#include "base/error.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/parallel.h"
#include "base/run_files.h"
#include "cli/job_server.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "cli/storey_operands.h"
#include "envc/envc_options.h"
#include "envc/envc_site.h"
#include "io/exporters.h"
#include "tools.h"

namespace {

using namespace ispace;

void envc(const EnvcOptions& options) {
    const ExportFormat* const format = options.format;
    if (format != nullptr && !format->binary.empty())
        refuseTerminal(options.common.output, std::string(format->binary));
    limitThreads(options.common.threads);
    if (options.task) return options.task();
    mustBeOneFile("--report", options.report);
    if (options.list_rooms || options.info) mustBeOneFile("--output", options.common.output);
    claimOutputs(options.common);
    if (format != nullptr) claimOutput(besideOf(options), std::string(format->beside_role));
    claimOutput(options.report, "--report");
    keepFreedMemory(options.inputs);
    const EnvcSite& site = leftToExit(readEnvcSite(options));
    warn(options.common, "envc", site.other_rooms);
    warn(options.common, "envc", site.report.choices);
    if (!options.check) warn(options.common, "envc", site.document.warnings);
    for (const std::string& note : site.document.notes) logInfo(options.common, "envc", note);
    EnvcOptions own = options;
    if (format != nullptr && site.document.isRoomAlone())
        own.common.output =
            roomFile(options.common.output, options.rules.storeys.one(), options.inputs.front());
    if (options.check)
        checkSite(own, site);
    else
        writeSite(own, site);
    writeDependencies(own.common, site.files);
}

}  // namespace

int ispace::runEnvc(int argc, char** argv) {
    return runTool("envc", argc, argv,
                   [](int count, char** words) { envc(ispace::parseEnvcOptions(count, words)); });
}
