// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/cli: results of a list's jobs that the next run reuses. SHA-256 of their
// inputs decides, so a file that was only touched counts as unchanged; outcomes stay on disk.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "base/part_file.h"
#include "cli/batch.h"

namespace ispace {

/// Outcomes of the jobs of a list, stored in the file of --cache from one run to the next. One is
/// reused if all files that its job read have the same bytes, those that it looked for in vain are
/// still missing, and its product, if it has one, is still there. Files that were written while
/// their job ran, or cannot be read again, make it not reusable; so does a failure.
class BatchCache {
  public:
    /// Reads the outcomes of earlier runs; those of another version, command or seed count as
    /// missing, and so do results that cannot be read and all from the first damaged record on.
    /// \throws FormatError if the file exists and is no such cache
    BatchCache(std::string file, const BatchRun& run);

    /// Returns the stored outcome of a job, or the result of `compute`. Thread-safe.
    JobOutcome outcomeOf(const BatchJob& job, const std::function<JobOutcome()>& compute);
    /// Returns the number of jobs whose outcome was reused.
    [[nodiscard]] std::size_t reused() const { return reused_; }
    /// Replaces the file by the outcomes of this run's jobs.
    void commit();

  private:
    /// \throws FormatError for a result of another form, whose hash is right
    [[nodiscard]] std::optional<JobOutcome> find(const BatchJob& job, const std::string& key);

    std::string file_;
    std::optional<JobResults> earlier_;
    JobResults results_;
    std::atomic<std::size_t> reused_ = 0;
};

}  // namespace ispace
