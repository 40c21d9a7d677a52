// SPDX-License-Identifier: GPL-3.0-or-later
// scan: computes readings of a scene's sensors.
#include <cstdint>
#include <string>

#include "base/file.h"
#include "cli/job_server.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "scan/scan_batch.h"
#include "scan/scan_options.h"
#include "scan/scan_run.h"
#include "tools.h"

namespace {

using namespace ispace;

/// Returns the suffix of the file that holds all readings of a scene; "/" if they take several.
std::string suffixOfReadings(const ScanToolOptions& options) {
    const std::string& format = options.format;
    if (format == "png" || format == "jpeg" || (cloudFormatOf(format) && !isOneCloud(options)))
        return "/";
    return format == "carmen" ? ".log" : format == "rgb24" ? ".rgb" : "." + format;
}

void scanJob(const ScanCommand& command, const BatchJob& job, const CommonOptions& common,
             JobOutcome& outcome) {
    ScanToolOptions options = command.options();
    options.common = common;
    options.operands = job.operands;
    options.batch.shard.reset();
    options.batch.resume = false;
    const std::int64_t readings = takeReadings(command, options);
    JsonWriter json = jobLine("scan", job);
    json.key("product").value(common.output).key("readings").value(readings);
    outcome.line = json.endObject().take() + '\n';
}

void scan(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    if (options.task) {
        limitThreads(options.common.threads);
        return options.task();
    }
    if (!options.batch.list.empty())
        return runBatch(
            {"scan", options.common, options.batch, command.historyLine({}), "",
             suffixOfReadings(options)},
            [&command](const BatchJob& job, const CommonOptions& common, JobOutcome& outcome) {
                scanJob(command, job, common, outcome);
            });
    claimOutputs(options.common);
    if (options.list_models) return writeAll(options.common.output, deviceTable(shippedDevices()));
    if (options.batch.merge) return mergeReadings(command);
    limitThreads(options.common.threads);
    if (!options.run.empty()) return writeRecorded(command);
    takeReadings(command, options);
}

}  // namespace

int ispace::runScan(int argc, char** argv) {
    return runTool("scan", argc, argv,
                   [](int count, char** words) { scan(ispace::ScanCommand(count, words)); });
}
