// SPDX-License-Identifier: GPL-3.0-or-later
// coverage: computes and draws the coverage of a scene's sensors.
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/parallel.h"
#include "base/run_files.h"
#include "cli/job_server.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "coverage/coverage_building.h"
#include "coverage/coverage_options.h"
#include "coverage/coverage_run.h"
#include "report/coverage_formats.h"
#include "report/coverage_report.h"
#include "report/page/coverage_page.h"
#include "report/presence_report.h"
#include "report/run_report.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"
#include "tools.h"

namespace {

using namespace ispace;

SceneInput readInput(const CoverageToolOptions& options) {
    const std::vector<std::string> operands = operandsOf(options);
    if (!options.report.empty() || options.suggestions)
        keepFreedMemory();  // of one picture or trial for the next
    else
        keepFreedMemory(operands);
    SceneInput input = readScene({operands, options.rules, true});
    addZones(options.zones, input);
    return input;
}

/// Returns a verdict for each --require.
std::vector<JunitCase> judgeAll(const CoverageToolOptions& options, const Coverage& coverage,
                                const Presence* presence) {
    std::vector<JunitCase> verdicts = judge(options.requirements, coverage);
    if (presence != nullptr)
        for (JunitCase& verdict : judge(options.presence_requirements, *presence))
            verdicts.push_back(std::move(verdict));
    return verdicts;
}

/// Reports the requirements that are met, and writes the verdicts on request. \throws UnmetError
void checkRequired(const CoverageToolOptions& options, const SceneInput& input,
                   std::vector<JunitCase> verdicts, const CameraRules* rules, JunitFile& junit) {
    if (rules != nullptr)
        for (JunitCase& verdict : judge(*rules)) verdicts.push_back(std::move(verdict));
    for (const JunitCase& verdict : verdicts)
        if (verdict.outcome == JunitCase::Outcome::Met)
            logInfo(options.common, "coverage", verdict.message);
    junit.write(baseName(input.environment_operand), verdicts);
    if (const std::string unmet = unmetText(verdicts); !unmet.empty()) throw UnmetError(unmet);
}

std::string reportText(const CoverageToolOptions& options, const CoverageReport& report,
                       const ReportParts& parts) {
    return options.json ? coverageJson(report, parts) : coverageText(report) + partsText(parts);
}

/// Frees all but the report, and the target.
void forgetViews(Coverage& coverage) {
    coverage.sensors = {};
    coverage.sets = {};
    coverage.overlay.reset();
    coverage.density_overlays = {};
    returnFreedMemory();
}

/// Returns the bytes of --report. The text of a page is as large as the views that its pictures
/// show: these are freed before it is written, see forgetViews().
std::string reportFile(const CoverageToolOptions& options, const SceneInput& input,
                       Coverage& coverage, const ReportParts& parts) {
    const std::string suffix = suffixOf(options.report);
    if (suffix == "json") return coverageJson(coverage.report, parts);
    CoveragePageInput page{input.scene, coverage, "", options.history_line};
    if (input.environment_operand != "-") page.name = baseName(input.environment_operand);
    const auto add = [&page](const std::string& phrase, const Verdict& verdict) {
        page.requirements.push_back({phrase, verdict.is_met, verdict.text, verdict.margin});
    };
    for (const Requirement& requirement : options.requirements)
        add(requirementPhrase(requirement), checkRequirement(requirement, coverage));
    if (parts.presence != nullptr)
        for (const PresenceRequirement& requirement : options.presence_requirements)
            add(requirementPhrase(requirement), checkRequirement(requirement, *parts.presence));
    page.parts = parts;
    page.findings = sensorFindings(input.scene);
    page.media =
        suffix == "pdf" ? CoveragePageInput::Media::Paper : CoveragePageInput::Media::Screen;
    page.cover = coverOf(options.page);
    page.paper = paperOf(options.page);
    page.prices = pricesOf(options.page);
    const auto progress = makeProgress("coverage", options.common.progress, options.common.quiet);
    page.progress = progress.get();
    const ReportPage pages = coveragePage(page);
    forgetViews(coverage);
    return suffix == "pdf" ? pdfOf(pages) : htmlOf(pages);
}

void coverScene(CoverageToolOptions options, JunitFile& junit) {
    const SceneInput& input = leftToExit(readInput(options));
    takeStorey(options, input);
    warnOfImport(options.common, "coverage", input);
    std::vector<std::string> files = filesOf(input);
    std::optional<OtherLayout> other;
    if (!options.other.empty()) {
        other = readOtherLayout(input, options.other, options.rules);
        warn(options.common, "coverage", other->warnings);
        files.insert(files.end(), other->files.begin(), other->files.end());
    }
    if (!options.trace.empty()) {
        options.map.trace = triedInRoom(options, input.storey, readTried(options, input.named));
        files.push_back(options.trace);
    }
    if (!options.report.empty()) mustBeWritable(options.report);
    if (!options.page.material.empty()) mustBeWritable(options.page.material);
    Measured& measured = *leftToExit(
        std::make_unique<Measured>(measureScene(options, input, other ? &other->scene : nullptr)));
    const CoverageReport& report = measured.coverage.report;
    const std::optional<RunCoverage> run = measureRecordedRun(options, input.scene);
    if (run) options.map.run = &*run;
    if (run) files.push_back(RecordedFiles(options.run).robots);
    if (options.presence && !options.presence->record.empty())
        files.push_back(RecordedFiles(options.presence->record).robots);
    const std::optional<ObjectiveFigures> objectives =
        objectivesOf(options, input.scene, measured.coverage);
    if (objectives) options.map.objectives = &*objectives;
    if (options.format != nullptr) {
        options.map.title =
            input.environment_operand == "-" ? "" : baseName(input.environment_operand);
        writeProduct(options, input, measured);
        writeDependencies(options.common, files);
    }
    const std::optional<Robustness> robustness =
        robustnessOf(options, input.scene, measured.coverage);
    const std::optional<CameraRules> rules = cameraRulesOf(options, input.scene, measured.coverage);
    const std::optional<Presence> presence = presenceOf(options, input.scene);
    // Last: once a signal has ended it, only the results are written.
    int signal = 0;
    const std::optional<Advice> advice = suggest(options, input, measured.coverage, signal);
    const ReportParts parts{options.map.run,
                            advice ? &*advice : nullptr,
                            robustness ? &*robustness : nullptr,
                            rules ? &*rules : nullptr,
                            presence ? &*presence : nullptr,
                            options.map.objectives};
    const std::vector<JunitCase> verdicts = judgeAll(options, measured.coverage, parts.presence);
    if (!options.report.empty())
        writeAll(options.report, reportFile(options, input, measured.coverage, parts));
    writeMaterial(options.page, input.scene);
    const CabledRoom room{input.scene, cablesOf(input.scene)};
    if (const std::string text = priceWarning(options.page, {&room, 1}); !text.empty())
        warn(options.common, "coverage", text);
    writeAll("-", reportText(options, report, parts));
    if (signal != 0) endBySignal(signal);
    logInfo(options.common, "coverage",
            std::to_string(report.sensors.size()) + " sensors measured on " +
                std::to_string(measured.coverage.target.grid.size()) + " cells");
    checkRequired(options, input, verdicts, parts.rules, junit);
}

/// Reports on the room of a job of --batch.
void coverRoomOf(const BatchJob& job, const CoverageToolOptions& options, JobOutcome& outcome) {
    SceneInput input = readScene({job.operands, options.rules, false});
    outcome.files = filesOf(input);
    addZones(options.zones, input);
    if (!input.layout && input.scene.sensors.empty())
        throw UsageError(input.environment_operand +
                         " holds no placed sensor: give a layout after it");
    warnOfImport(options.common, "coverage", input);
    const Coverage coverage = measureScene(options, input, nullptr).coverage;
    outcome.line = coverageJson(coverage.report);
    outcome.verdicts = judge(options.requirements, coverage, job.name + ": ");
}

/// --batch: a report for each scene of the list, see runBatch().
void measureList(const CoverageToolOptions& options) {
    runBatch({"coverage", options.common, options.batch,
              options.command + readingText(options.rules), options.junit},
             [&](const BatchJob& job, const CommonOptions& common, JobOutcome& outcome) {
                 CoverageToolOptions own = options;
                 own.common = common;
                 if (!coverBuildingOf(job, own, outcome)) coverRoomOf(job, own, outcome);
                 if (const std::string unmet = unmetText(outcome.verdicts); !unmet.empty())
                     throw UnmetError(unmet);
             });
}

void coverage(const CoverageToolOptions& options) {
    limitThreads(options.common.threads);
    claimOutputs(options.common);
    claimOutput(options.report, "--report");
    claimOutput(options.page.material, "--material");
    claimOutput(options.junit, "--junit");
    if (options.format != nullptr && options.format->beside_suffix != nullptr)
        claimOutput(withSuffix(options.common.output, options.format->beside_suffix),
                    "the picture of the map");
    JunitFile junit("coverage", options.junit);
    junit.during(options.operands, [&] {
        if (!coverBuilding(options, junit)) coverScene(options, junit);
    });
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
