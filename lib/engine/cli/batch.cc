// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/batch.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/packed.h"
#include "base/part_file.h"
#include "base/run_files.h"
#include "cli/batch_cache.h"
#include "cli/job_loop.h"
#include "cli/kept_rooms.h"
#include "cli/outputs.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "record/text.h"
#include "sim/sim_time.h"

namespace ispace {

void addListOption(CommandLine& line, BatchOptions& options, const std::string& help) {
    line.file(
        "--batch", "LIST", options.list,
        "a process for many scenes: LIST (- is stdin) has a line `ENV [LAYOUT]` for each; " + help,
        Enters::Nothing);
}

void addBatchOptions(CommandLine& line, BatchOptions& options, const std::string& shares,
                     bool has_parts) {
    line.parsed(
        "--shard", "I/N", [&options](const std::string& text) { options.shard = parseShard(text); },
        "do the I-th of N shares of the job (" + shares + ")" +
            (has_parts ? " and write a part for --merge" : ""),
        Enters::Nothing);
    if (has_parts) {
        line.flag("--merge", options.merge,
                  "merge the parts of all shards, which are the operands, to the output of one run",
                  Enters::Nothing);
        line.manyOperandsWith(options.merge);
    }
    line.flag("--resume", options.resume,
              "store completed work in FILE.resume beside the output, and continue a killed run of "
              "the same command from there",
              Enters::Nothing);
}

void addCacheOption(CommandLine& line, BatchOptions& options) {
    line.file(
        "--cache", "FILE", options.cache,
        "with --batch: reuse the results of scenes whose files are those of the last run with "
        "FILE, and store all results there",
        Enters::Nothing);
}

namespace {

void checkList(const CommandLine& line, const BatchOptions& options,
               const std::vector<std::string>& operands, std::span<const char* const> single) {
    if (options.merge) throw UsageError("--merge joins parts, and --batch writes none");
    if (!operands.empty())
        throw UsageError("--batch takes scenes from LIST: put " + operands.front() +
                         " on a line of it");
    std::vector<std::string> names(single.begin(), single.end());
    names.insert(names.end(), {"--MD", "--MF"});
    for (const std::string& name : names)
        if (line.given(name))
            throw UsageError((name[2] == 'M' ? name.substr(1) : name) +
                             " is about one scene, and --batch about many");
}

}  // namespace

void checkBatchOptions(const CommandLine& line, const BatchOptions& options,
                       const CommonOptions& common, const std::vector<std::string>& operands,
                       std::span<const char* const> single) {
    if (!options.list.empty()) {
        checkList(line, options, operands, single);
    } else if (options.merge) {
        if (options.shard) throw UsageError("--merge joins what shards made: leave out --shard");
        if (options.resume) throw UsageError("--merge takes moments: leave out --resume");
        if (operands.empty()) throw UsageError("--merge: name the parts of all shards");
        // The parts store the options that change the result.
        const std::string words = line.historyLine({});
        if (const std::size_t blank = words.find(' '); blank != std::string::npos) {
            const std::string rest = words.substr(blank + 1);
            throw UsageError("--merge: the parts know their options; leave out " +
                             rest.substr(0, rest.find(' ')));
        }
    }
    if (!options.cache.empty() && options.list.empty())
        throw UsageError("--cache is about many scenes: give --batch LIST");
    if (!options.cache.empty() && isStream(options.cache))
        throw UsageError("--cache is read and replaced: give it a regular file");
    const std::string suffix = suffixOf(common.output);
    if (options.shard && options.list.empty() && !suffix.empty() && suffix != "part" &&
        !OutputSet::of(common.output))
        throw UsageError("--shard writes a part, which --merge makes a whole: name it " +
                         withoutSuffix(common.output) +
                         ".part, and the format by --to if it is "
                         "not the default");
    if (options.resume && !OutputSet::of(common.output) && isStream(common.output))
        throw UsageError("--resume needs a file (-o): what went into a stream is gone");
}

namespace {

constexpr std::size_t kMaxOperands = 2;

/// Returns the operands on a line, empty for a blank one or a comment. \throws LexError
std::vector<std::string> operandsOn(std::string_view line) {
    std::vector<std::string> operands;
    LineLexer lexer(line);
    while (lexer.more()) {
        const Piece word = lexer.word();
        if (word.text.empty()) throw LexError{"an empty name", word.column};
        if (word.text == "-")
            throw LexError{"stdin is not read by a job of a list: give a file", word.column};
        if (operands.size() == kMaxOperands)
            throw LexError{"more than ENV and LAYOUT: put names with blanks in quotes",
                           word.column};
        operands.emplace_back(word.text);
    }
    return operands;
}

}  // namespace

std::string BatchJob::text() const {
    std::string text;
    for (const std::string& operand : operands)
        text.append(text.empty() ? "" : " ").append(operand);
    return text;
}

std::vector<BatchJob> readBatchList(std::string_view bytes, const std::string& name) {
    checkTextBytes(bytes, name);
    std::vector<BatchJob> jobs;
    LineReader lines(withoutBom(bytes));
    while (const auto line = lines.next()) {
        try {
            std::vector<std::string> operands = operandsOn(*line);
            if (!operands.empty()) jobs.push_back({lines.number(), std::move(operands)});
        } catch (const LexError& error) {
            jobs.push_back({lines.number(), {}, error.message});
        }
    }
    if (jobs.empty()) throw FormatError({name, 0, 0, "no job found, wanted lines `ENV [LAYOUT]`"});
    return jobs;
}

namespace {

using JobVerdict = JunitCase::Outcome;

}  // namespace

std::string JobOutcome::bytes() const {
    Packer to;
    to.add(static_cast<std::uint64_t>(status));
    to.addText(line);
    to.add(messages.size());
    for (const Diagnostic& message : messages) {
        to.add(static_cast<std::uint64_t>(message.severity));
        to.addText(message.file);
        to.add(static_cast<std::uint64_t>(message.line));
        to.add(static_cast<std::uint64_t>(message.column));
        to.addText(message.message);
    }
    to.add(verdicts.size());
    for (const JunitCase& verdict : verdicts) {
        to.add(static_cast<std::uint64_t>(verdict.outcome));
        to.addText(verdict.name);
        to.addText(verdict.message);
    }
    return to.bytes();
}

JobOutcome JobOutcome::fromBytes(std::string_view bytes) {
    Unpacker from(bytes);
    JobOutcome outcome;
    outcome.status = static_cast<int>(from.number());
    outcome.line = from.text();
    for (std::uint64_t left = from.number(); left > 0; --left) {
        Diagnostic& message = outcome.messages.emplace_back();
        message.severity = static_cast<Severity>(from.number());
        message.file = from.text();
        message.line = static_cast<int>(from.number());
        message.column = static_cast<int>(from.number());
        message.message = from.text();
    }
    for (std::uint64_t left = from.number(); left > 0; --left) {
        JunitCase& verdict = outcome.verdicts.emplace_back();
        verdict.outcome = static_cast<JobVerdict>(from.number());
        verdict.name = from.text();
        verdict.message = from.text();
    }
    return outcome;
}

JsonWriter jobLine(const std::string& tool, const BatchJob& job) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-batch/1").key("tool").value(tool);
    json.key("version").value(version()).key("line").value(job.line);
    json.key("operands").value(job.operands);
    return json;
}

namespace {

/// Names the products: %s is the first operand without folder and suffix, %d the line.
void nameProducts(const BatchRun& run, std::vector<BatchJob>& jobs) {
    const bool is_folder = run.product == "/";
    const auto names = OutputSet::of(run.common.output);
    if (!names || (is_folder && !suffixOf(run.common.output).empty()))
        throw UsageError(std::string("--batch writes a ") + (is_folder ? "folder" : "file") +
                         " for each line of LIST: name a folder for them (-o DIR/) or a pattern "
                         "(-o '%s-%04d" +
                         (is_folder ? "" : run.product) + "')");
    std::set<std::string> taken, folders;
    for (const BatchJob& job : jobs) taken.insert(job.operands.begin(), job.operands.end());
    for (BatchJob& job : jobs) {
        if (!job.wrong.empty()) continue;
        job.product = names->fileOf(withoutSuffix(baseName(job.operands.front())), job.line,
                                    is_folder ? "" : run.product);
        if (!taken.insert(job.product).second)
            throw UsageError("--output: " + job.product +
                             " is an operand of LIST, or the file of two lines: write %04d where "
                             "the number of the line goes");
        folders.insert(std::filesystem::path(job.product).parent_path());
        if (is_folder) job.product += '/';
    }
    for (const std::string& folder : folders)
        if (!folder.empty()) std::filesystem::create_directories(folder);
}

/// Rejects pipes and devices unopened: a list is a file that names others. Other errors are left to
/// the readers. \throws FormatError
void checkKinds(const BatchJob& job) {
    for (const std::string& name : job.operands) {
        std::error_code error;
        const auto status = std::filesystem::status(name, error);
        if (std::filesystem::is_other(status))
            throw FormatError({displayName(name), 0, 0, "it is no regular file"});
    }
}

JobOutcome outcomeOf(const BatchRun& run, const BatchJob& job, const JobWork& work) {
    JobOutcome outcome;
    CommonOptions common = run.common;
    common.output = job.product;
    common.progress = false;
    common.messages = [&outcome](const Diagnostic& message) {
        outcome.messages.push_back(message);
    };
    try {
        if (!job.wrong.empty()) throw UsageError(job.wrong);
        checkKinds(job);
        work(job, common, outcome);
    } catch (...) {
        const ToolFailure failure = currentFailure();
        const std::string error = failure.messages.front().text();
        outcome.status = failure.status;
        outcome.messages.insert(outcome.messages.end(), failure.messages.begin(),
                                failure.messages.end());
        if (failure.status != JobOutcome::kUnmet)
            outcome.verdicts = {{.name = job.name, .outcome = JobVerdict::Error, .message = error}};
        if (outcome.line.empty() && !run.product.empty())
            outcome.line =
                jobLine(run.tool, job).key("error").value(error).endObject().take() + '\n';
    }
    if (outcome.line.empty()) outcome.line = "null\n";
    return outcome;
}

/// Writes the results of the jobs, in their order.
class BatchWriter {
  public:
    explicit BatchWriter(const BatchRun& run)
        : run_(run), lines_(run.product.empty() ? run.common.output : "-") {}

    void take(const BatchJob& job, JobOutcome outcome) {
        lines_.write(outcome.line);
        for (const Diagnostic& message : outcome.messages)
            writeJobMessage(run_.tool, {.file = run_.batch.list, .line = job.line}, message);
        if (outcome.status != 0) ++(outcome.status == JobOutcome::kUnmet ? unmet_ : failed_);
        std::move(outcome.verdicts.begin(), outcome.verdicts.end(), std::back_inserter(verdicts_));
    }

    void commit(JunitFile& junit) {
        lines_.commit();
        junit.write(baseName(run_.batch.list), verdicts_);
    }

    /// \param cache may be null \throws as runBatch
    void conclude(std::size_t jobs, const BatchCache* cache) const {
        const auto share = [jobs](std::size_t count) {
            return std::to_string(count) + " of " + std::to_string(jobs) + " jobs ";
        };
        if (failed_ > 0)
            throw FormatError(
                {displayName(run_.batch.list), 0, 0, share(failed_) + "failed, see above"});
        if (unmet_ > 0) throw UnmetError(share(unmet_) + "missed a requirement");
        logInfo(run_.common, run_.tool,
                std::to_string(jobs) + " jobs done" +
                    (cache == nullptr ? ""
                                      : ", " + std::to_string(cache->reused()) +
                                            " of them known from " + run_.batch.cache));
    }

  private:
    const BatchRun& run_;
    OutputFile lines_;
    std::vector<JunitCase> verdicts_;
    std::size_t failed_ = 0, unmet_ = 0;
};

/// Decides for the jobs of a list which of their rooms are kept: those that a later job names as
/// well. If they are more than can be kept, that job must be near.
class SharedRooms {
  public:
    explicit SharedRooms(std::span<const BatchJob> jobs) : jobs_(jobs), next_(jobs.size()) {
        std::map<std::string_view, std::size_t> last;
        std::set<std::string_view> shared;
        for (std::size_t i = jobs.size(); i-- > 0;)
            for (const std::string& file : jobs[i].operands) {
                const auto [found, is_new] = last.try_emplace(file, i);
                next_[i].push_back(is_new ? kNever : found->second - i);
                if (!is_new && !file.ends_with(".3dm")) shared.insert(file);
                found->second = i;
            }
        reach_ = shared.size() > kMostKeptRooms ? kMostKeptRooms : kNever - 1;
    }

    [[nodiscard]] std::vector<std::string> of(std::size_t job) const {
        std::vector<std::string> rooms;
        for (std::size_t k = 0; k < next_[job].size(); ++k)
            if (next_[job][k] <= reach_) rooms.push_back(jobs_[job].operands[k]);
        return rooms;
    }

  private:
    static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

    std::span<const BatchJob> jobs_;
    std::vector<std::vector<std::size_t>> next_;  // lines to the next job with the same operand
    std::size_t reach_ = 0;
};

/// Returns the identity of a list's results. \param list its bytes
JobId idOf(const BatchRun& run, const std::string& list, std::size_t jobs) {
    JobId id;
    id.tool = run.tool;
    id.history = {run.command};
    id.inputs = sha256(list);
    id.seed = run.common.seed;
    id.form = "jobs";
    id.units = static_cast<std::int64_t>(jobs);
    return id;
}

void runShare(const BatchRun& run, const JobWork& work, JunitFile& junit) {
    const std::string& list = run.batch.list;
    const std::string bytes = list == "-" ? readStdin() : readAll(list);
    std::vector<BatchJob> jobs = readBatchList(bytes, displayName(list));
    for (BatchJob& job : jobs)
        job.name = baseName(list) + ':' + std::to_string(job.line) + ' ' + job.text();
    if (!run.product.empty()) nameProducts(run, jobs);
    const Shard shard = run.batch.shard.value_or(Shard());
    const auto [first, end] = shard.blockOf(std::ssize(jobs));
    const std::span own = std::span(jobs).subspan(static_cast<std::size_t>(first),
                                                  static_cast<std::size_t>(end - first));
    std::optional<JobResults> results;
    if (run.batch.resume)
        results.emplace(run.common.output, idOf(run, bytes, jobs.size()), shard, true);
    std::optional<BatchCache> cache;
    if (!run.batch.cache.empty()) cache.emplace(run.batch.cache, run);
    const auto outcome_of = [&](const BatchJob& job) {
        const auto compute = [&] { return outcomeOf(run, job, work); };
        return cache ? cache->outcomeOf(job, compute) : compute();
    };
    BatchWriter writer(run);
    const SharedRooms shared(own);
    const auto progress = makeProgress(run.tool, run.common.progress, run.common.quiet);
    progress->begin("scenes", std::ssize(own));
    const auto deliver = [&](const BatchJob& job, const JobOutcome& outcome) {
        writer.take(job, outcome);
        progress->advance(1);
    };
    std::size_t next = 0;
    runJobs(LoopThreads::All, [&]() -> std::optional<LoopJob> {
        if (next == own.size()) return std::nullopt;
        const std::size_t number = next++;
        const BatchJob& job = own[number];
        const std::string key = std::to_string(job.line);
        if (const auto done = results ? results->find(key) : std::nullopt)
            return LoopJob{.work = [&, outcome = JobOutcome::fromBytes(*done)] {
                return [&, outcome] { deliver(job, outcome); };
            }};
        // The cache may know the result; then no room is read.
        return LoopJob{.rooms = cache ? std::vector<std::string>() : shared.of(number),
                       .work = [&, key] {
                           return [&, key, outcome = outcome_of(job)] {
                               if (results) results->store(key, outcome.bytes());
                               deliver(job, outcome);
                           };
                       }};
    });
    progress->end();
    writer.commit(junit);
    if (results) results->finish();
    if (cache) cache->commit();
    writer.conclude(own.size(), cache ? &*cache : nullptr);
}

}  // namespace

void runBatch(const BatchRun& run, const JobWork& work) {
    keepFreedMemory();  // of one job for the next
    limitThreads(run.common.threads);
    claimOutputs(run.common);
    claimOutput(run.junit, "--junit");
    claimOutput(run.batch.cache, "--cache");
    JunitFile junit(run.tool, run.junit);
    junit.during({&run.batch.list, 1}, [&] { runShare(run, work, junit); });
}

}  // namespace ispace
