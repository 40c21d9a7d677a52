// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "sense/reading_format.h"
#include "sense/reading_source.h"

namespace ispace {

/// Some readings, ready to be written: in the order of their jobs.
struct Readings {
    std::vector<ReadingJob> jobs;
    std::string text;                             ///< of a stream
    std::vector<std::vector<ReadingFile>> files;  ///< of each job, where each has files of its own
    std::vector<PointCloud> clouds;               ///< of each job, where they are joined
};

/// What becomes of a reading.
enum class Packing { Stream, Files, Clouds };

/// Takes all readings of a source, shared out over all cores by jobs, and hands them to `write` in
/// order, by one thread at a time. Memory is bounded by the number of cores, not by that of jobs.
/// Where the source fails, what comes before is written all the same.
void runReadings(ReadingSource& source, ReadingTaker& taker, const Sensors& sensors,
                 const ReadingFormat& format, Packing packing, Coordinates coordinates,
                 Progress& progress, const std::function<void(Readings&)>& write);

}  // namespace ispace
