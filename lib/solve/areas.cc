// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/areas.h"

namespace ispace {

Areas areasAbout(const Problem& problem, const std::vector<Choice>& near,
                 const std::vector<std::uint32_t>& multipliers) {
    Areas areas;
    std::vector<std::vector<std::uint32_t>> most;
    for (const Kind& kind : problem.kinds) {
        areas.emplace_back(kind.candidates->size(), 0U);
        most.emplace_back(kind.candidates->size(), 0U);
    }
    std::vector<std::uint32_t> weights;
    for (std::uint32_t area = 0; area < near.size(); ++area) {
        std::vector<std::uint32_t> seen(problem.cells(), 0);
        problem.kinds[near[area].kind].candidates->forEachRun(
            near[area].candidate, [&](const CellRun& run) {
                for (std::uint32_t i = run.first; i < run.end; ++i) seen[i] = multipliers[i];
            });
        const WeightSums sums(seen);
        for (std::size_t k = 0; k < problem.kinds.size(); ++k) {
            weights.resize(areas[k].size());
            problem.kinds[k].candidates->weighAll(sums, weights);
            for (std::size_t i = 0; i < weights.size(); ++i) {
                if (weights[i] <= most[k][i]) continue;
                most[k][i] = weights[i];
                areas[k][i] = area;
            }
        }
    }
    return areas;
}

}  // namespace ispace
