// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

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

}  // namespace ispace
