// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/greedy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

namespace ispace {

namespace {

using Candidates = std::vector<Candidate>;

/// The candidate that adds most to what is covered; the first among equals.
struct Best {
    std::size_t index = 0, gain = 0;
};

Best bestOf(const Candidates& candidates, const CellSet& covered) {
    std::vector<std::size_t> gains(candidates.size());
    tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
        const CellSet& seen = candidates[i].seen;
        gains[i] = seen.count() - countCommon(seen, covered);
    });
    const auto best = std::max_element(gains.begin(), gains.end());
    return {static_cast<std::size_t>(best - gains.begin()), *best};
}

}  // namespace

Placement placeGreedily(const std::vector<Choice>& choices, const CellSet& covered,
                        Progress& progress) {
    Placement placement{{}, covered, 0};
    CellSet reachable = covered;
    std::vector<const Candidates*> kinds;  // each once, in order of first use
    for (const Choice& choice : choices)
        if (std::find(kinds.begin(), kinds.end(), choice.candidates) == kinds.end())
            kinds.push_back(choice.candidates);
    for (const Candidates* kind : kinds)
        for (const Candidate& candidate : *kind) reachable |= candidate.seen;
    placement.bound = reachable.count();

    // The best set adds to any set S at most the sum, over its sensors, of the best addition to S.
    const auto bound_from = [&](const std::map<const Candidates*, Best>& best) {
        std::size_t sum = placement.covered.count();
        for (const Choice& choice : choices) sum += best.at(choice.candidates).gain;
        placement.bound = std::min(placement.bound, sum);
    };
    const auto best_per_kind = [&] {
        std::map<const Candidates*, Best> best;
        for (const Candidates* kind : kinds) best[kind] = bestOf(*kind, placement.covered);
        return best;
    };

    progress.begin("placing", static_cast<std::int64_t>(choices.size()));
    for (const Choice& choice : choices) {
        const auto best = best_per_kind();
        bound_from(best);
        const std::size_t index = best.at(choice.candidates).index;
        placement.chosen.push_back(index);
        placement.covered |= (*choice.candidates)[index].seen;
        progress.advance(1);
    }
    bound_from(best_per_kind());
    progress.end();
    return placement;
}

}  // namespace ispace
