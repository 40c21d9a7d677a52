// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/part_file.h"
#include "base/shard.h"
#include "cli/command_line.h"
#include "cli/common_options.h"

namespace ispace {

/// How a job is shared out, joined, or gone on with.
struct BatchOptions {
    std::optional<Shard> shard;
    bool merge = false;  ///< operands are parts
    bool resume = false;
};

/// Declares --shard I/N, --merge and --resume. \param shares what the shards share out, for help
void addBatchOptions(CommandLine& line, BatchOptions& options, const std::string& shares);

/// Checks them against each other and the rest. \throws UsageError for --merge without operands,
/// with --shard or --resume, or with an option that the parts know; for the output of a shard with
/// another suffix than .part; for --resume to stdout
void checkBatchOptions(const CommandLine& line, const BatchOptions& options,
                       const CommonOptions& common, const std::vector<std::string>& operands);

/// The file beside an output where --resume keeps what is done: OUTPUT.resume, in a folder of its
/// own name `.resume`.
std::string checkpointOf(const std::string& output);

/// True if `file` is the finished part of this very shard: then --resume has nothing to do. A file
/// that is no such part is about to be replaced.
bool isDoneAlready(const std::string& file, const PartHead& head);

}  // namespace ispace
