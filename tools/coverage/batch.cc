// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/batch.h"

#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/part_file.h"
#include "base/program.h"
#include "base/run_files.h"
#include "cli/batch_list.h"
#include "cli/batch_options.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "cli/run_tool.h"
#include "cover/coverage_report.h"
#include "coverage/judge.h"
#include "coverage/measured.h"
#include "coverage/outcome.h"
#include "layout/scene.h"
#include "record/text.h"
#include "trace/worlds.h"

namespace ispace {

namespace {

/// Measures jobs one by one, from any thread.
class BatchWorker {
  public:
    explicit BatchWorker(const CoverageToolOptions& options) : options_(options) {}

    [[nodiscard]] SceneOutcome run(const BatchJob& job) const {
        SceneOutcome outcome;
        try {
            measure(job, outcome);
        } catch (...) {
            const ToolFailure failure = currentFailure();
            outcome.failed = true;
            outcome.messages.insert(outcome.messages.end(), failure.lines.begin(),
                                    failure.lines.end());
            outcome.verdicts = {{.name = nameOf(job),
                                 .outcome = JunitCase::Outcome::Error,
                                 .message = failure.lines.front()}};
        }
        return outcome;
    }

  private:
    void measure(const BatchJob& job, SceneOutcome& outcome) const {
        if (!job.wrong.empty()) throw UsageError(job.wrong);
        SceneInput input = readScene(
            {.operands = job.operands, .rules = options_.rules, .layout_from_stdin = false});
        addZones(options_.zones, input);
        const Scene& scene = input.scene;
        if (!input.layout && scene.sensors.empty())
            throw UsageError(input.environment_operand +
                             " holds no placed sensor: give a layout after it");
        for (const Requirement& requirement : options_.requirements)
            mustHaveZone(requirement, scene.environment);
        outcome.messages = input.choices;
        for (const Diagnostic& warning : input.environment.warnings)
            outcome.messages.push_back(warning.text());
        for (const Diagnostic& warning : sensorFindings(scene))
            outcome.messages.push_back(warning.text());
        Worlds worlds(scene.environment);
        const Coverage coverage = measureCoverage(scene, worlds, options_.measure);
        if (std::string text = largeCellsText(options_.measure, coverage.report.grid);
            !text.empty())
            outcome.messages.push_back(std::move(text));
        if (options_.common.quiet) outcome.messages.clear();
        outcome.verdicts = judge(options_.requirements, coverage, nameOf(job) + ": ");
        if (std::string unmet = unmetText(outcome.verdicts); !unmet.empty())
            outcome.messages.push_back("error: " + unmet);
        outcome.report = coverageJson(coverage.report);
    }

    /// For CI servers: the same for whoever runs the list, wherever it is.
    [[nodiscard]] std::string nameOf(const BatchJob& job) const {
        return baseName(options_.batch) + ':' + std::to_string(job.line) + ' ' + job.text();
    }

    const CoverageToolOptions& options_;
};

/// Writes what became of the jobs, in their order.
class BatchWriter {
  public:
    BatchWriter(const CoverageToolOptions& options, JunitFile& junit)
        : options_(options), reports_(options.common.output), junit_(junit) {}

    void take(const BatchJob& job, const SceneOutcome& outcome) {
        reports_.write(outcome.report);
        for (const std::string& message : outcome.messages)
            sayLine({"coverage: ", displayName(options_.batch), ":", std::to_string(job.line), ": ",
                     printable(message)});
        if (outcome.failed) ++failed_;
        if (!unmetText(outcome.verdicts).empty()) ++unmet_;
        verdicts_.insert(verdicts_.end(), outcome.verdicts.begin(), outcome.verdicts.end());
    }

    void commit() {
        reports_.commit();
        junit_.write(baseName(options_.batch), verdicts_);
    }

    /// \throws as runBatch
    void conclude(std::size_t jobs) const {
        const auto share = [jobs](std::size_t count) {
            return std::to_string(count) + " of " + std::to_string(jobs) + " jobs ";
        };
        if (failed_ > 0)
            throw FormatError(
                {displayName(options_.batch), 0, 0, share(failed_) + "failed, see above"});
        if (unmet_ > 0) throw UnmetError(share(unmet_) + "missed a requirement");
        talk(options_.common, "coverage", std::to_string(jobs) + " jobs done");
    }

  private:
    const CoverageToolOptions& options_;
    OutputFile reports_;
    JunitFile& junit_;
    std::vector<JunitCase> verdicts_;
    std::size_t failed_ = 0, unmet_ = 0;
};

/// What identifies the results of a list. \param list its bytes
JobId jobOf(const CoverageToolOptions& options, const std::string& list, std::size_t jobs) {
    JobId id;
    id.tool = "coverage";
    id.history = {options.command};
    id.inputs = sha256(list);
    id.form = "jsonl";
    id.units = static_cast<std::int64_t>(jobs);
    return id;
}

void runShare(const CoverageToolOptions& options, JunitFile& junit) {
    const std::string list = options.batch == "-" ? readStdin() : readAll(options.batch);
    const std::vector<BatchJob> jobs = readBatchList(list, displayName(options.batch));
    const auto [first, end] = options.shard.blockOf(static_cast<std::int64_t>(jobs.size()));
    const auto count = static_cast<std::size_t>(end - first);
    std::optional<JobResults> results;
    if (options.resume)
        results.emplace(options.common.output, jobOf(options, list, jobs.size()), options.shard,
                        true);
    const BatchWorker worker(options);
    BatchWriter writer(options, junit);
    const auto progress = makeProgress("coverage", options.common.progress, options.common.quiet);
    progress->begin("scenes", static_cast<std::int64_t>(count));
    runInOrder(count, [&, first = static_cast<std::size_t>(first)](std::size_t i) {
        const BatchJob& job = jobs[first + i];
        const std::string key = std::to_string(first + i + 1);
        const auto done = results ? results->find(key) : std::nullopt;
        return [&, key, is_new = !done,
                outcome = done ? SceneOutcome::fromText(*done) : worker.run(job)] {
            if (results && is_new) results->store(key, outcome.text());
            writer.take(job, outcome);
            progress->advance(1);
        };
    });
    progress->end();
    writer.commit();
    if (results) results->finish();
    writer.conclude(count);
}

}  // namespace

void runBatch(const CoverageToolOptions& options) {
    limitThreads(options.common.threads);
    claimOutputs(options.common);
    claimOutput(options.junit, "--junit");
    JunitFile junit("coverage", options.junit);
    junit.during({&options.batch, 1}, [&] { runShare(options, junit); });
}

}  // namespace ispace
