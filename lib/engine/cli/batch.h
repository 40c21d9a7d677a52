// SPDX-License-Identifier: GPL-3.0-or-later
// Options and loops of tools that do a list of jobs, or a share of one job, in a process: --batch,
// --shard, --merge, --resume and --cache. Output and messages come in the order of the list, so
// they are the same for any number of threads; a job that fails stops no other.
//
//     runBatch({"coverage", options.common, options.batch, options.command},
//              [&](const BatchJob& job, const CommonOptions& common, JobOutcome& outcome) {
//                  JsonWriter line = jobLine("coverage", job);
//                  outcome.line = line.key("area").value(areaOf(job)).endObject().take() + '\n';
//              });
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/shard.h"
#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/junit.h"

namespace ispace {

/// Lists of jobs; sharing, joining and resuming of one.
struct BatchOptions {
    std::string list;  ///< file of --batch; "": one job
    std::optional<Shard> shard;
    bool merge = false;  ///< operands are parts
    bool resume = false;
    std::string cache = {};  ///< file of --cache; "": none
};

/// Declares --batch LIST. \param help the work for each line, and its output
void addListOption(CommandLine& line, BatchOptions& options, const std::string& help);

/// Declares --shard I/N, --merge and --resume. \param shares the units that shards divide, for help
/// \param has_parts false: there is no --merge
void addBatchOptions(CommandLine& line, BatchOptions& options, const std::string& shares,
                     bool has_parts = true);

/// Declares --cache FILE.
void addCacheOption(CommandLine& line, BatchOptions& options);

/// Validates them against each other and the rest. \param single options that apply to one scene
/// \throws UsageError for --merge without operands, with --shard or --resume, or with an option
/// that the parts store; for the output of a shard with another suffix than .part; for --resume to
/// stdout; for --batch with operands, --merge, -MD or one of `single`
void checkBatchOptions(const CommandLine& line, const BatchOptions& options,
                       const CommonOptions& common, const std::vector<std::string>& operands,
                       std::span<const char* const> single = {});

/// One job of a list: the operands of a command.
struct BatchJob {
    int line = 0;  ///< number of its line in the list
    std::vector<std::string> operands;
    std::string wrong = {};    ///< why it is rejected, "" if it is valid
    std::string name = {};     ///< list, line and operands: the same on every machine
    std::string product = {};  ///< the file or folder it writes; "" without

    /// Joins the operands by blanks.
    [[nodiscard]] std::string text() const;
};

/// Parses a list of jobs, a line `ENV [LAYOUT]` each. Names are words or "strings" by the rules for
/// values of records; skips blank lines and comments. Invalid lines become jobs with an error.
/// O(bytes) \throws FormatError for bytes that are no text, and for a list without a job
std::vector<BatchJob> readBatchList(std::string_view bytes, const std::string& name);

/// Result of one job of a list.
struct JobOutcome {
    std::string line = {};                  ///< of JSON; "": the job failed
    std::vector<Diagnostic> messages = {};  ///< for stderr
    std::vector<JunitCase> verdicts = {};
    static constexpr int kUnmet = 3;
    int status = 0;  ///< exit status of the job by itself; kUnmet: it missed a requirement
    /// All that it was computed from, besides the command; empty if it is not to be reused. Not in
    /// bytes().
    std::vector<std::string> files = {};

    /// Converts the result to bytes for checkpoints.
    [[nodiscard]] std::string bytes() const;
    /// \throws FormatError for truncated bytes
    static JobOutcome fromBytes(std::string_view bytes);
};

/// A list of jobs, done in one process.
struct BatchRun {
    std::string tool;
    CommonOptions common;
    BatchOptions batch;
    std::string command;  ///< history line without operands: results of others are rejected
    std::string junit = {};
    /// Suffix of the file that each job writes, "/" for a folder; "": the only output are lines.
    std::string product = {};
};

/// Does one job; thread-safe. `common`: those of the run, with the job's product as output and its
/// messages collected. Sets the line, and the verdicts if there are any; its exceptions become
/// messages.
using JobWork =
    std::function<void(const BatchJob& job, const CommonOptions& common, JobOutcome& outcome)>;

/// Begins the line of a job: an object with schema, tool, version, line and operands.
JsonWriter jobLine(const std::string& tool, const BatchJob& job);

/// Does all jobs of a list, or the share of a shard, on all threads, and writes their lines in its
/// order: to stdout if there are products, else to the output. The jobs of sweeps run in the same
/// loop (cli/job_loop.h); a room that several jobs name is read once.
/// \throws UnmetError if one missed a requirement, FormatError if one failed; both after the last
/// job; UsageError for equal names of products and for a product that is an operand
void runBatch(const BatchRun& run, const JobWork& work);

}  // namespace ispace
