// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/simrun_report.h"

#include "base/file.h"
#include "base/run_files.h"
#include "cli/common_options.h"
#include "coverage/run_coverage.h"
#include "report/page/coverage_page.h"
#include "sim/recorder.h"
#include "trace/ray_world.h"

namespace ispace {

std::string reportFile(const SimrunOptions& options, const SceneInput& input,
                       const ExpectationJudge& judge, const std::string& command) {
    for (const std::string& file : Recorder::filesIn(options.record)) completeOutput(file);
    const Scene& scene = input.scene;
    Worlds worlds(scene.environment);
    const Coverage coverage = measureCoverage(scene, worlds, {});
    RunReader reader(options.record);
    RunChanges changes = changesOfRun(options.record, scene, options.rules.max_work);
    RunCoverage run = measureRun(scene, reader, {}, &changes);
    run.name = baseName(options.record);
    CoveragePageInput page{scene, coverage, "", command};
    if (input.environment_operand != "-") page.name = baseName(input.environment_operand);
    for (const RunVerdict& verdict : judge.verdicts())
        page.requirements.push_back({verdict.expectation, verdict.is_met, verdict.reason});
    page.parts.run = &run;
    const std::string suffix = suffixOf(options.report);
    if (suffix == "json") return coverageJson(coverage.report, {.run = &run});
    const ReportPage pages = coveragePage(page);
    return suffix == "pdf" ? pdfOf(pages) : htmlOf(pages);
}

}  // namespace ispace
