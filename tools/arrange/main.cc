// SPDX-License-Identifier: GPL-3.0-or-later
// arrange: arranges sensors in a room and writes the layout.

#include "arrange/arrange.h"
#include "arrange/arrange_batch.h"
#include "arrange/arrange_options.h"
#include "arrange/arrange_report.h"
#include "arrange/arrange_run.h"
#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "base/run_files.h"
#include "cli/job_server.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "record/text.h"
#include "report/curve_chart.h"
#include "report/trace_file.h"
#include "site/arranged_site.h"
#include "tools.h"

namespace {

using namespace ispace;

/// Returns true if the rest of a run after a signal is useless, or is stored elsewhere.
bool endsWithoutProduct(const ArrangeToolOptions& options) {
    return options.batch.resume ||
           (options.batch.shard && !isOfProof(options.how.search.share.what));
}

void writeLayout(const ArrangeCommand& command, const ArrangeToolOptions& options,
                 const ArrangeWork& work, const Arrangement& arrangement) {
    const SiteInput& input = work.input;
    const Document* const before = input.layout ? &*input.layout : nullptr;
    LayoutParts parts{
        input.layout ? input.layout->history : History(),
        environmentFileFor(options.common.output, input.environment_operand),
        input.digest(),
        std::string(work.how.prover ? work.how.prover->name() : nameOf(work.how.strategy)),
        std::string(nameOf(work.how.prover ? Optimizer::Exact : work.how.search.optimizer)),
        std::string(work.how.demand      ? work.how.demand->name()
                    : work.how.objective ? work.how.objective->name()
                                         : "")};
    parts.history.push_back(command.historyLine(input.named));
    const auto document = [&](const Arrangement& found) {
        return !input.isOneRoom()
                   ? buildingLayout(parts, input.building, before, work.groups, found)
                   : layoutDocument(parts, before, work.groups, found);
    };
    const Document layout = document(arrangement);
    if (!options.trace_file.empty())
        writeAll(options.trace_file, writeTrace({parts.history, arrangement.tried}));
    if (!options.report_file.empty())
        writeAll(options.report_file,
                 reportFile(options, work, arrangement, layout, command.historyLine(input.named)));
    writeReportLists(options, work, arrangement, layout);
    if (!options.heat_file.empty()) writeHeat(options, work, arrangement);
    if (const std::string file = options.certificateFile(); !file.empty() && arrangement.proof)
        if (const auto certificate = arrangement.proof->certificate(parts.history)) {
            writeAll(file, certificate->text);
            if (!certificate->weakness.empty())
                warn(options.common, "arrange", certificate->weakness);
        }
    if (const std::string& file = options.curve_file; !file.empty())
        writeAll(file, curveFile(arrangement.curve, outputFormat({}, file, curveFormats())));
    for (std::size_t i = 0; i < arrangement.alternatives.size(); ++i)
        writeAll(numberedFile(options.common.output, i + 2),
                 writeRecordText(document(arrangement.alternatives[i])));
    writeAll(options.common.output, writeRecordText(layout));
    writeDependencies(options.common, work.files);
}

/// Reports the layout, and unmet requests.
void reportLayout(const ArrangeToolOptions& options, const ArrangeWork& work,
                  const Arrangement& arrangement, const ArrangeFindings& findings) {
    if (!options.common.quiet)
        writeLines("arrange", reportText(work, arrangement) +
                                  alternativesText(options.common.output, arrangement));
    for (const ArrangeFindings::Line& line : findings.lines)
        report(options.common, "arrange", line.text);
    if (!options.common.quiet)
        for (const ArrangeFindings::Line& line : figuresOf(options, work, arrangement).lines)
            report(options.common, "arrange", line.text);
    const auto asked = static_cast<std::size_t>(work.how.alternatives);
    if (const std::size_t count = arrangement.alternatives.size(); count < asked)
        report(options.common, "arrange",
               std::to_string(count) + " of " + std::to_string(asked) +
                   " alternatives were found: the candidates have no more layouts that differ");
    logInfo(options.common, "arrange",
            "total effective area " + formatFixed(arrangement.area, 2) + " m2, cost " +
                formatDouble(arrangement.cost));
}

/// \throws UnmetError as checkGoals(), and for findings that are not met
void checkAll(const ArrangeToolOptions& options, const ArrangeWork& work,
              const Arrangement& arrangement, const ArrangeFindings& findings) {
    checkGoals(options, work, arrangement);
    std::string unmet;
    for (const ArrangeFindings::Line& line : findings.lines)
        if (line.is_unmet) unmet.append(unmet.empty() ? "" : "; ").append(line.text);
    if (!unmet.empty()) throw UnmetError(unmet);
}

/// Reports that a signal left no product, and ends by it.
[[noreturn]] void endWithNothing(const ArrangeToolOptions& options, int signal,
                                 const std::string& text) {
    report(options.common, "arrange", text);
    endBySignal(signal);
}

/// Ends by a signal that leaves no product.
Arrangement search(const ArrangeToolOptions& options, const ArrangeWork& work, SearchWatch& watch) {
    std::optional<FileStream> mps;
    if (!options.mps_file.empty()) mps.emplace(options.mps_file);
    Arrangement arrangement;
    try {
        arrangement = work.run(watch, mps ? &mps->stream() : nullptr);
    } catch (const UnmetError&) {
        if (watch.signal() == 0) throw;
        endWithNothing(options, watch.signal(),
                       "stopped before there was a layout: nothing is written");
    }
    if (mps) mps->commit();
    if (watch.signal() != 0 && endsWithoutProduct(options))
        endWithNothing(options, watch.signal(),
                       std::string("stopped: nothing is written") +
                           (options.batch.resume ? ", the same command goes on" : ""));
    return arrangement;
}

/// Reserves the further files of --heat, if the number of sensors is known.
void claimHeat(const ArrangeToolOptions& options, const ArrangeWork& work) {
    if (options.heat_file.empty()) return;
    int sensors = 0;
    for (const SensorGroup& group : work.groups) sensors += group.most;
    if (options.how.target || options.how.budget) sensors = 1;
    for (int i = 1; i <= sensors; ++i)
        for (const std::string& file : heatFiles(options, work, static_cast<std::size_t>(i))) {
            if (file == options.heat_file) continue;
            claimOutput(file, "a map of --heat");
            mustBeWritable(file);
        }
}

/// \param parts those of a merge, or null
void runCommand(const ArrangeCommand& command, std::unique_ptr<JobResults> parts) {
    const ArrangeToolOptions& options = command.options();
    const std::optional<Shard>& shard = options.batch.shard;
    limitThreads(options.common.threads);
    claimOutputs(options.common);
    claimOutput(options.trace_file, "--trace");
    claimOutput(options.curve_file, "--curve");
    claimOutput(options.mps_file, "--export-mps");
    claimOutput(options.report_file, "--report");
    for (const ReportGroup::SideFile& beside : options.reports->files())
        claimOutput(*beside.file, beside.option);
    claimOutput(options.heat_file, "--heat");
    const std::string certificate = options.certificateFile();
    claimOutput(certificate, "--certificate");
    ArrangeWork work = readWork(options);
    for (int i = 0; i < options.how.alternatives; ++i) {
        const std::string file =
            numberedFile(options.common.output, static_cast<std::size_t>(i) + 2);
        claimOutput(file, "an alternative");
        mustBeWritable(file);
    }
    claimHeat(options, work);
    for (const std::string* file :
         {&options.common.output, &options.trace_file, &options.curve_file, &options.mps_file,
          &options.report_file, &options.heat_file, &certificate})
        mustBeWritable(*file);
    for (const ReportGroup::SideFile& beside : options.reports->files())
        mustBeWritable(*beside.file);
    warnOfSearch(options, work);
    bool is_done = false;
    const auto results = resultsOf(command, work, std::move(parts), is_done);
    if (is_done)
        return logInfo(options.common, "arrange", options.common.output + " is done already");
    work.how.search.share.results = results.get();
    int signal = 0;
    Arrangement arrangement;
    {
        SearchWatch watch(makeProgress("arrange", options.common.progress, options.common.quiet),
                          options.time_limit);
        arrangement = search(options, work, watch);
        if (shard)
            writePart(command, *results);
        else
            writeLayout(command, options, work, arrangement);
        if (results && (shard || arrangement.is_complete)) results->finish();
        signal = watch.signal();
    }
    if (results && !results->trouble().empty())
        warn(options.common, "arrange", "results could not be stored: " + results->trouble());
    const ArrangeFindings findings =
        shard ? ArrangeFindings() : findingsOf(options, work, arrangement);
    if (shard)
        writeDependencies(options.common, work.files);
    else
        reportLayout(options, work, arrangement, findings);
    if (signal != 0) endBySignal(signal);
    if (shard)
        logInfo(options.common, "arrange", "shard " + shard->text() + " is written");
    else
        checkAll(options, work, arrangement, findings);
}

/// Arranges the sensors of one scene of a list.
void arrangeJob(const ArrangeCommand& command, const BatchJob& job, const CommonOptions& common,
                JobOutcome& outcome) {
    ArrangeToolOptions options = command.options();
    options.common = common;
    options.operands = job.operands;
    const ArrangeWork work = readWork(options);
    warnOfSearch(options, work);
    SearchWatch watch(std::make_unique<SilentProgress>(), options.time_limit, false);
    const Arrangement found = work.run(watch);
    if (found.is_complete) outcome.files = work.files;
    writeLayout(command, options, work, found);
    JsonWriter json = jobLine("arrange", job);
    json.key("product").value(common.output).key("sensors").value(found.sensors.size());
    json.key("coverage").value(roundSignificant(found.coverage));
    json.key("area").value(roundSignificant(found.area));
    json.key("value").value(roundSignificant(found.value.value_or(found.coverage)));
    json.key("bound").value(roundSignificant(found.bound)).key("cost").value(found.cost);
    json.key("candidates").value(found.candidates).key("unplaced").value(found.unplaced);
    json.key("reached").value(found.is_reached).key("complete").value(found.is_complete);
    outcome.line = json.endObject().take() + '\n';
    checkAll(options, work, found, findingsOf(options, work, found));
}

void arrangeSensors(const ArrangeCommand& command) {
    const ArrangeToolOptions& options = command.options();
    if (options.task) return options.task();
    if (!options.batch.list.empty())
        return runBatch(
            {"arrange", options.common, options.batch,
             command.historyLine({}) + readingText(options.rules), "", ".3dm"},
            [&command](const BatchJob& job, const CommonOptions& common, JobOutcome& outcome) {
                arrangeJob(command, job, common, outcome);
            });
    if (!options.batch.merge) {
        return runCommand(command, nullptr);
    }
    auto parts =
        std::make_unique<JobResults>(mergeParts(options.operands, "arrange", kCommandKey, false));
    const auto made_by = commandOf(*parts, options);
    runCommand(*made_by, std::move(parts));
}

}  // namespace

int ispace::runArrange(int argc, char** argv) {
    return runTool("arrange", argc, argv, [](int count, char** words) {
        arrangeSensors(ispace::ArrangeCommand(count, words));
    });
}
