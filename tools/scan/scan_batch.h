// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/part_file.h"
#include "scan/scan_options.h"
#include "scan/scan_run.h"

namespace ispace {

/// True if a run takes a share of the readings, or keeps what is done.
bool isBatch(const ScanToolOptions& options);

/// The job that the command is about. \param format how readings are written \param poses the text
/// of --poses, "" without \param units all readings
JobId readingsJob(const ScanCommand& command, const SceneInput& input, const ReadingFormat& format,
                  const std::string& poses, std::int64_t units);

/// The readings that a run has to take, and where they go.
struct OwnReadings {
    Shard::Block block;
    std::unique_ptr<Delivery> delivery;  ///< null: the part is there already
};
/// The share of --shard, without what --resume finds done. \pre isBatch()
/// \throws UsageError where readings cannot be joined; as JobResults
OwnReadings ownReadings(const ScanToolOptions& options, const JobId& job, const Sensors& sensors,
                        const ReadingFormat& format);

/// --merge: writes what one run would have written.
void mergeReadings(const ScanCommand& command);

}  // namespace ispace
