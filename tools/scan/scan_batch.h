// SPDX-License-Identifier: GPL-3.0-or-later
// Parts and results of scan: --shard, --merge and --resume.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/part_file.h"
#include "scan/scan_options.h"
#include "scan/scan_run.h"

namespace ispace {

/// Returns true if a run takes a share of the readings, or stores completed ones.
bool isBatch(const ScanToolOptions& options);

/// Returns the job of the command. \param format of the readings \param poses the text of --poses,
/// "" without \param units all readings
JobId readingsJob(const ScanCommand& command, const SiteInput& input, const ReadingFormat& format,
                  const std::string& poses, std::int64_t units);

/// The readings that a run has to take, and their output.
struct OwnReadings {
    Shard::Block block;
    std::unique_ptr<Delivery> delivery;  ///< null: the part exists already
};
/// Returns the share of --shard, less the readings that --resume finds. \pre isBatch()
/// \throws UsageError if readings cannot be joined; as JobResults
OwnReadings ownReadings(const ScanToolOptions& options, const JobId& job, const Sensors& sensors,
                        const ReadingFormat& format);

/// --merge: writes the output of the unsharded run.
void mergeReadings(const ScanCommand& command);

}  // namespace ispace
