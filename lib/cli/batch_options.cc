// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/batch_options.h"

#include "base/error.h"
#include "cli/outputs.h"

namespace ispace {

void addBatchOptions(CommandLine& line, BatchOptions& options, const std::string& shares) {
    line.parsed(
        "--shard", "I/N", [&options](const std::string& text) { options.shard = parseShard(text); },
        "do the I-th of N shares of the job (" + shares + ") and write a part for --merge",
        Enters::Nothing);
    line.flag("--merge", options.merge,
              "merge the parts of all shards, which are the operands, to the output of one run",
              Enters::Nothing);
    line.flag("--resume", options.resume,
              "store completed work in FILE.resume beside the output, and continue a killed run of "
              "the same command from there",
              Enters::Nothing);
    line.manyOperandsWith(options.merge);
}

void checkBatchOptions(const CommandLine& line, const BatchOptions& options,
                       const CommonOptions& common, const std::vector<std::string>& operands) {
    if (options.merge) {
        if (options.shard) throw UsageError("--merge joins what shards made: leave out --shard");
        if (options.resume) throw UsageError("--merge takes moments: leave out --resume");
        if (operands.empty()) throw UsageError("--merge: name the parts of all shards");
        // What changes the result is in the parts.
        const std::string words = line.historyLine({});
        if (const std::size_t blank = words.find(' '); blank != std::string::npos) {
            const std::string rest = words.substr(blank + 1);
            throw UsageError("--merge: the parts know their options; leave out " +
                             rest.substr(0, rest.find(' ')));
        }
    }
    const std::string suffix = suffixOf(common.output);
    if (options.shard && !suffix.empty() && suffix != "part" && !OutputSet::of(common.output))
        throw UsageError("--shard writes a part, which --merge makes a whole: name it " +
                         withoutSuffix(common.output) +
                         ".part, and the format by --to if it is "
                         "not the default");
    if (options.resume && !OutputSet::of(common.output) && isStream(common.output))
        throw UsageError("--resume needs a file (-o): what went into a stream is gone");
}

}  // namespace ispace
