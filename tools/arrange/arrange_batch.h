// SPDX-License-Identifier: GPL-3.0-or-later
// Parts and results of arrange: --shard, --merge and --resume.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "arrange/arrange_run.h"
#include "base/part_file.h"

namespace ispace {

/// The record of a part with the words of the command, each ended by a NUL.
constexpr std::string_view kCommandKey = "command";

/// Returns the command line that made the parts, as that of a merge, with the outputs and verbosity
/// of `merge`. \throws FormatError, also for records that no such shard writes
std::unique_ptr<ArrangeCommand> commandOf(const JobResults& parts, const ArrangeToolOptions& merge);

/// Returns the store of the search's steps: the parts of a merge, or the results of a shard or of a
/// run with --resume; null for other runs, and with `is_done` for an existing part.
/// \param parts those of a merge, or null
/// \throws UsageError for a shard that reads a stream; as JobResults
std::unique_ptr<JobResults> resultsOf(const ArrangeCommand& command, const ArrangeWork& work,
                                      std::unique_ptr<JobResults> parts, bool& is_done);

/// Writes the part of a shard.
void writePart(const ArrangeCommand& command, JobResults& results);

}  // namespace ispace
