// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/cell_set.h"
#include "solve/candidate_set.h"

namespace ispace {

/// What candidates see: runs of cells, ascending, that do not touch each other.
using SeenRuns = std::vector<CellRun>;

/// What a candidate sees. O(n log n) for n runs.
SeenRuns runsOf(const CandidateSet& set, std::uint32_t candidate);
/// What is in both. O(n)
SeenRuns commonOf(const SeenRuns& a, const SeenRuns& b);

/// Weights of what one candidate sees, summed up, so that its share of what others see is quick to
/// tell.
class MaskedSums {
  public:
    explicit MaskedSums(std::size_t cells) : sums_(cells + 1) {}
    /// O(cells)
    void assign(const SeenRuns& runs, const std::uint32_t* weights);
    /// Weight of what is seen in these runs, too. O(n) for n runs.
    [[nodiscard]] std::int64_t of(const SeenRuns& runs) const {
        std::uint32_t sum = 0;
        for (const CellRun& run : runs) sum += sums_[run.end] - sums_[run.first];
        return sum;
    }

  private:
    std::vector<std::uint32_t> sums_;  // [i]: of all before cell i
};

}  // namespace ispace
