// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/coverage_run.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/part_file.h"
#include "base/run_files.h"
#include "cli/batch.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "record/text.h"
#include "report/coverage_formats.h"
#include "report/coverage_report.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"
#include "sense/ultrasound.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

/// A layout may add furniture, which is part of the comparison, but must not replace the room.
void mustBeSameRoom(const Environment& room, const Environment& other, const std::string& file) {
    if (room.limits() == other.limits() && room.indoor() == other.indoor()) return;
    throw FormatError({displayName(file), 0, 0,
                       "its walls make another room: layouts of one room can be compared"});
}

/// Returns the content of a model: the records of the scene, below the history of both inputs and
/// this command.
Document documentOf(const CoverageToolOptions& options, const SceneInput& input) {
    Document document;
    document.history = input.environment.history;
    if (input.layout)
        document.history.insert(document.history.end(), input.layout->history.begin(),
                                input.layout->history.end());
    document.history.push_back(options.history_line);
    document.records = input.scene.records;
    rebaseFiles(document.records, "",
                std::filesystem::path(options.common.output).parent_path().string());
    return document;
}

}  // namespace

Measured measure(const CoverageToolOptions& options, const Scene& scene, const Scene* other) {
    Worlds worlds(scene.environment);
    Measured measured{measureCoverage(scene, worlds, options.measure), {}};
    if (other == nullptr) return measured;
    mustBeSameRoom(scene.environment, other->environment, options.other);
    Worlds other_worlds(other->environment);
    measured.other = measureCoverage(*other, other_worlds, options.measure);
    compare(measured.coverage, *measured.other, scene.environment.indoor(),
            options.other == "-" ? displayName("-") : baseName(options.other));
    return measured;
}

std::optional<RunCoverage> lookAtRun(const CoverageToolOptions& options, const Scene& scene) {
    if (options.run.empty()) return std::nullopt;
    RunReader reader(options.run);
    RunChanges changes = changesOfRun(options.run, scene);
    RunCoverage run =
        measureRun(scene, reader,
                   {.plane = options.measure.plane, .density = options.measure.density}, &changes);
    if (!changes.failure().empty()) warn(options.common, "coverage", changes.failure());
    run.name = baseName(options.run);
    if (reader.isCut())
        warn(options.common, "coverage",
             "the record ends in the midst of a step, which is left out");
    return run;
}

void writeProduct(const CoverageToolOptions& options, const SceneInput& input,
                  const Measured& measured) {
    const std::string& output = options.common.output;
    const CoverageFormat& format = *options.format;
    CoverageProduct product{input.scene, measured.coverage,
                            measured.other ? &*measured.other : nullptr, options.map};
    product.document = documentOf(options, input);
    product.speeds = options.speeds;
    if (const auto* cells = std::get_if<CellSize>(&options.measure.cells))
        product.cell = cells->edge;
    if (format.beside_suffix == nullptr) {
        writeAll(output, format.write(product).product);
        return;
    }
    const std::string beside = withSuffix(output, format.beside_suffix);
    product.beside_name = std::filesystem::path(beside).filename().string();
    const CoverageFiles files = format.write(product);
    writeTogether(std::vector<NamedBytes>{{beside, files.beside}, {output, files.product}});
}

std::vector<Diagnostic> sensorFindings(const Scene& scene) {
    std::vector<Diagnostic> found =
        sceneWarnings(scene, {.checks = {"unplaced", "outside", "buried"}});
    if (const std::size_t count = sensorsOf<Receiver>(scene).size();
        count > 0 && count < kMinReceivers)
        found.push_back(
            {.file = "",
             .message = "ultrasound covers nothing: at least " + std::to_string(kMinReceivers) +
                        " receivers have to hear a tag, here are " + std::to_string(count),
             .severity = Severity::Warning});
    return found;
}

std::string largeCellsText(const CoverageOptions& options, const Grid& grid) {
    const double edge = roundSignificant(grid.limits.width() / grid.columns);
    if (!std::holds_alternative<RoomCells>(options.cells) || edge <= kRoomCell) return "";
    return "the room is large: cells are " + formatDouble(edge) + " m instead of " +
           formatDouble(kRoomCell) + " m (--cell M makes them smaller)";
}

std::vector<JunitCase> judge(std::span<const Requirement> requirements, const Coverage& coverage,
                             const std::string& name) {
    std::vector<JunitCase> verdicts;
    verdicts.reserve(requirements.size());
    for (const Requirement& requirement : requirements) {
        const auto [is_met, text] = checkRequirement(requirement, coverage);
        verdicts.push_back({.name = name + requirementText(requirement),
                            .outcome = is_met ? JunitCase::Outcome::Met : JunitCase::Outcome::Unmet,
                            .message = text});
    }
    return verdicts;
}

std::string unmetText(std::span<const JunitCase> verdicts) {
    std::string text;
    for (const JunitCase& verdict : verdicts)
        if (verdict.outcome == JunitCase::Outcome::Unmet)
            text.append(text.empty() ? "" : "; ").append(verdict.message);
    return text;
}

namespace {

// Each line after the report begins with its type; the parts of a verdict are separated by tabs,
// which printable() removes from all other text.
constexpr char kFailed = 'f', kMessage = 'm', kMet = '0', kUnmet = '1', kError = '2';

char letterOf(JunitCase::Outcome outcome) {
    return outcome == JunitCase::Outcome::Met     ? kMet
           : outcome == JunitCase::Outcome::Unmet ? kUnmet
                                                  : kError;
}

JunitCase verdictOf(char letter, std::string_view parts) {
    const auto tab = parts.find('\t');
    return {.name = std::string(parts.substr(0, tab)),
            .outcome = letter == kMet     ? JunitCase::Outcome::Met
                       : letter == kUnmet ? JunitCase::Outcome::Unmet
                                          : JunitCase::Outcome::Error,
            .message = std::string(parts.substr(tab + 1))};
}

}  // namespace

std::string SceneOutcome::text() const {
    std::string text = report;
    if (failed) text.append(1, kFailed) += '\n';
    for (const std::string& message : messages)
        text.append(1, kMessage).append(printable(message)) += '\n';
    for (const JunitCase& verdict : verdicts) {
        text.append(1, letterOf(verdict.outcome)).append(printable(verdict.name)) += '\t';
        text.append(printable(verdict.message)) += '\n';
    }
    return text;
}

SceneOutcome SceneOutcome::fromText(std::string_view text) {
    LineReader lines(text);
    SceneOutcome outcome{.report = std::string(lines.next().value_or("null")) + '\n'};
    while (const auto line = lines.next()) {
        if (line->empty()) continue;
        const char letter = line->front();
        const std::string_view rest = line->substr(1);
        if (letter == kFailed)
            outcome.failed = true;
        else if (letter == kMessage)
            outcome.messages.emplace_back(rest);
        else
            outcome.verdicts.push_back(verdictOf(letter, rest));
    }
    return outcome;
}

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

    /// For CI servers: the same name on every machine and in every folder.
    [[nodiscard]] std::string nameOf(const BatchJob& job) const {
        return baseName(options_.batch) + ':' + std::to_string(job.line) + ' ' + job.text();
    }

    const CoverageToolOptions& options_;
};

/// Writes the results of the jobs, in their order.
class BatchWriter {
  public:
    BatchWriter(const CoverageToolOptions& options, JunitFile& junit)
        : options_(options), reports_(options.common.output), junit_(junit) {}

    void take(const BatchJob& job, const SceneOutcome& outcome) {
        reports_.write(outcome.report);
        for (const std::string& message : outcome.messages)
            writeErrorLine({"coverage: ", displayName(options_.batch), ":",
                            std::to_string(job.line), ": ", printable(message)});
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

/// Returns the identity of a list's results. \param list its bytes
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
