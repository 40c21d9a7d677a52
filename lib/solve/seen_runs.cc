// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/seen_runs.h"

#include <algorithm>

namespace ispace {

SeenRuns runsOf(const CandidateSet& set, std::uint32_t candidate) {
    SeenRuns runs, joined;
    set.forEachRun(candidate, [&runs](const CellRun& run) { runs.push_back(run); });
    std::sort(runs.begin(), runs.end(),
              [](const CellRun& a, const CellRun& b) { return a.first < b.first; });
    for (const CellRun& run : runs) {
        if (!joined.empty() && joined.back().end == run.first)
            joined.back().end = run.end;
        else
            joined.push_back(run);
    }
    return joined;
}

SeenRuns commonOf(const SeenRuns& a, const SeenRuns& b) {
    SeenRuns both;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        const CellRun run{std::max(a[i].first, b[j].first), std::min(a[i].end, b[j].end)};
        if (run.first < run.end) both.push_back(run);
        if (a[i].end < b[j].end)
            ++i;
        else
            ++j;
    }
    return both;
}

void MaskedSums::assign(const SeenRuns& runs, const std::uint32_t* weights) {
    std::uint32_t sum = 0;
    std::size_t cell = 0;
    const auto at = [this](std::size_t i) {
        return sums_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    for (const CellRun& run : runs) {
        std::fill(at(cell), at(run.first), sum);
        for (cell = run.first; cell < run.end; ++cell) {
            sums_[cell] = sum;
            sum += weights[cell];
        }
    }
    std::fill(at(cell), sums_.end(), sum);
}

}  // namespace ispace
