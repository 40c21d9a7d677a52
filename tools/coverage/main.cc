// SPDX-License-Identifier: GPL-3.0-or-later
// coverage: computes and draws the coverage of a site's sensors.
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/parallel.h"
#include "base/run_files.h"
#include "cli/job_server.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "cli/storey_operands.h"
#include "coverage/coverage_options.h"
#include "coverage/coverage_run.h"
#include "report/coverage_formats.h"
#include "scene/scene.h"
#include "tools.h"

namespace {

using namespace ispace;

SiteInput readInput(const CoverageToolOptions& options) {
    const std::vector<std::string> operands =
        options.operands.empty() ? options.groups->recordedSite() : options.operands;
    if (!options.report.empty() || options.groups->isAsked())
        keepFreedMemory();  // of one picture or trial for the next
    else
        keepFreedMemory(operands);
    SiteInput input = readSite({operands, options.rules, true});
    addZones(inOwnStorey(input, options.zones), input.building);
    return input;
}

/// Reports the requirements that are met, and writes the verdicts on request. \throws UnmetError
void checkRequired(const CoverageToolOptions& options, const SiteInput& input,
                   const std::vector<JunitCase>& verdicts, JunitFile& junit) {
    for (const JunitCase& verdict : verdicts)
        if (verdict.outcome == JunitCase::Outcome::Met)
            logInfo(options.common, "coverage", verdict.message);
    junit.write(baseName(input.environment_operand), verdicts);
    if (const std::string unmet = unmetText(verdicts); !unmet.empty()) throw UnmetError(unmet);
}

/// Frees all but the reports, and the targets.
void forgetViews(SiteCoverage& coverage) {
    for (Coverage& room : coverage.storeys) {
        room.sensors = {};
        room.sets = {};
        room.overlay.reset();
        room.density_overlays = {};
    }
    returnFreedMemory();
}

/// Returns the bytes of --report. The text of a page is as large as the views that its pictures
/// show: these are freed before it is written, see forgetViews().
std::string reportFile(const CoverageToolOptions& options, const SiteInput& input,
                       SiteResults& results) {
    const ReportGroup* const form = options.reports->of(options.report);
    const SiteCoverage& coverage = results.coverage;
    if (form == nullptr) return siteCoverageJson(input.building, coverage, results.parts());
    SiteReport report{input.building, coverage, "", options.history_line};
    if (input.environment_operand != "-") report.name = baseName(input.environment_operand);
    const auto add = [&report](const std::string& phrase, const Verdict& verdict) {
        report.requirements.push_back({phrase, verdict.is_met, verdict.text, verdict.margin});
    };
    for (const Requirement& requirement : options.requirements)
        add(requirementPhrase(requirement),
            checkRequirement(requirement, input.building, coverage));
    for (const JudgedShare& one : results.found.judged)
        if (!one.phrase.empty()) add(one.phrase, one.verdict);
    report.parts = results.parts();
    report.findings = sensorFindings(input.building);
    const auto progress = makeProgress("coverage", options.common.progress, options.common.quiet);
    report.progress = progress.get();
    const ReportPage page = form->page(report, options.report);
    forgetViews(results.coverage);
    return form->bytesOf(page, options.report);
}

/// Warns of options that are about cameras, where there are none.
void warnOfCameras(const CoverageToolOptions& options, const SiteInput& input) {
    for (const auto& scene : input.rooms())
        for (const Sensor& sensor : scene->sensors)
            if (sensor.is<Camera>()) return;
    if (options.measure.density > 0)
        warn(options.common, "coverage", "--density changes nothing: no sensor is a camera");
    if (options.measure.parallax)
        warn(options.common, "coverage", "--parallax changes nothing: no sensor is a camera");
}

void coverSite(CoverageToolOptions options, JunitFile& junit) {
    const SiteInput& input = leftToExit(readInput(options));
    fitOptions(options, input);
    warnOfImport(options.common, "coverage", input);
    warnOfCameras(options, input);
    std::vector<std::string> files = input.files;
    if (!options.report.empty()) mustBeWritable(options.report);
    for (const ReportGroup::SideFile& beside : options.reports->files())
        mustBeWritable(*beside.file);
    SiteResults& results = *leftToExit(std::make_unique<SiteResults>());
    results.tried = readTried(options, input);
    if (!options.trace.empty()) files.push_back(options.trace);
    measure(options, input, files, results);
    const MeasuredSite site{input,          results.coverage, options.measure, options.requirements,
                            options.common, options.rules};
    options.groups->measure(site, results.found, false);
    files.insert(files.end(), results.found.files.begin(), results.found.files.end());
    if (options.format != nullptr) {
        writeProducts(options, input, results);
        writeDependencies(options.common, files);
    }
    // Last: once a signal has ended a search, only the results are written.
    options.groups->measure(site, results.found, true);
    const std::vector<JunitCase> verdicts = judgeAll(options, input.building, results);
    if (!options.report.empty()) writeAll(options.report, reportFile(options, input, results));
    if (options.reports->isAsked())
        warn(options.common, "coverage", options.reports->writeFiles(input.rooms()));
    const SiteParts parts = results.parts();
    writeAll("-", options.json ? siteCoverageJson(input.building, results.coverage, parts)
                               : siteCoverageText(input.building, results.coverage, parts));
    if (results.found.signal != 0) endBySignal(results.found.signal);
    std::size_t sensors = 0, cells = 0;
    for (const Coverage& room : results.coverage.storeys) {
        sensors += room.report.sensors.size();
        cells += room.target.grid.size();
    }
    logInfo(options.common, "coverage",
            std::to_string(sensors) + " sensors measured on " + std::to_string(cells) + " cells");
    checkRequired(options, input, verdicts, junit);
}

/// Reports on the site of a job of --batch.
void coverJob(const BatchJob& job, const CoverageToolOptions& options, JobOutcome& outcome) {
    SiteInput input = readSite({job.operands, options.rules, false});
    outcome.files = input.files;
    addZones(inOwnStorey(input, options.zones), input.building);
    if (!input.layout && std::all_of(input.rooms().begin(), input.rooms().end(),
                                     [](const auto& scene) { return scene->sensors.empty(); }))
        throw UsageError(input.environment_operand +
                         " holds no placed sensor: give a layout after it");
    warnOfImport(options.common, "coverage", input);
    CoverageToolOptions own = options;
    nameInRoom(own, input);
    SiteResults results;
    std::vector<std::string> files;  // of --compare, which batches do not have
    measure(own, input, files, results);
    outcome.line = siteCoverageJson(input.building, results.coverage);
    outcome.verdicts = judge(own.requirements, input.building, results.coverage, job.name + ": ");
}

/// --batch: a report for each scene of the list, see runBatch().
void measureList(const CoverageToolOptions& options) {
    runBatch({"coverage", options.common, options.batch,
              options.command + readingText(options.rules), options.junit},
             [&](const BatchJob& job, const CommonOptions& common, JobOutcome& outcome) {
                 CoverageToolOptions own = options;
                 own.common = common;
                 coverJob(job, own, outcome);
                 if (const std::string unmet = unmetText(outcome.verdicts); !unmet.empty())
                     throw UnmetError(unmet);
             });
}

void coverage(const CoverageToolOptions& options) {
    limitThreads(options.common.threads);
    mustBeOneFile("--report", options.report);
    for (const ReportGroup::SideFile& beside : options.reports->files())
        mustBeOneFile(beside.option, *beside.file);
    mustBeOneFile("--junit", options.junit);
    claimOutputs(options.common);
    claimOutput(options.report, "--report");
    for (const ReportGroup::SideFile& beside : options.reports->files())
        claimOutput(*beside.file, beside.option);
    claimOutput(options.junit, "--junit");
    if (options.format != nullptr && options.format->beside_suffix != nullptr)
        claimOutput(withSuffix(options.common.output, options.format->beside_suffix),
                    "the picture of the map");
    JunitFile junit("coverage", options.junit);
    junit.during(options.operands, [&] { coverSite(options, junit); });
}

}  // namespace

int ispace::runCoverage(int argc, char** argv) {
    return runTool("coverage", argc, argv, [](int count, char** words) {
        const auto options = ispace::parseCoverageOptions(count, words);
        if (options.task) {
            limitThreads(options.common.threads);
            options.task();
        } else if (options.batch.list.empty())
            coverage(options);
        else
            measureList(options);
    });
}
