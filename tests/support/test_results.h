// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of shards and of runs that continue: job results in a folder of the test.
#pragma once

#include <cstddef>
#include <string>

#include "base/part_file.h"
#include "support/test_folder.h"

namespace ispace {

/// Results in a temporary folder, kept or not.
class TestResults {
  public:
    explicit TestResults(bool is_kept = false)
        : results_(folder_ / "results", jobOfTest(), {}, is_kept) {}
    [[nodiscard]] JobResults* get() { return &results_; }
    /// The results that another process would find.
    void takeFrom(const TestResults& other, const std::string& prefix = "") {
        for (const std::string& key : other.results_.keys())
            if (key.starts_with(prefix)) results_.store(key, other.results_.find(key).value());
    }
    [[nodiscard]] std::size_t size() const { return results_.keys().size(); }

  private:
    static JobId jobOfTest() {
        JobId job;
        job.tool = "arrange";
        return job;
    }
    testing::TestFolder folder_;
    JobResults results_;
};

}  // namespace ispace
