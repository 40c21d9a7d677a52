// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/lagrange.h"

#include <algorithm>

#include "solve/multiplier_search.h"
#include "solve/root_relaxation.h"
#include "solve/search_notes.h"

namespace ispace {
namespace {

constexpr int kTrials = 20;        // between two looks at all candidates
constexpr int kRoundsToJudge = 4;  // by what these gain

bool isGood(const Bound& bound, const LagrangeLimits& limits) {
    return static_cast<double>(bound.value - std::min(bound.value, limits.cut)) <=
           limits.gap * static_cast<double>(bound.value);
}

}  // namespace

Bound boundWithin(const Problem& problem, const std::vector<Choice>& near,
                  const LagrangeLimits& limits, Progress& progress) {
    RootRelaxation root(problem);
    const RelaxedCells& cells = root.cells();
    Bound bound;
    bound.scale = cells.scale;
    bound.cut = limits.cut;
    bound.value = std::max(problem.totalWeight(), limits.cut);
    bound.multipliers = root.startFrom(near);
    const std::uint64_t cut = cells.most(limits.cut);
    const std::size_t sensors = root.counts().total();
    const std::size_t working = std::clamp<std::size_t>(64 * sensors, 128, 512);
    progress.begin("bounding", limits.rounds);
    MultiplierSearch search(cells.weights, bound.multipliers, static_cast<double>(cut));
    std::vector<std::uint64_t> leasts;  // after each round
    for (int round = 0; round <= limits.rounds && !progress.stopped(); ++round) {
        const std::uint64_t now = root.evaluate(round == 0 ? search.trial() : search.best(), true);
        if (round == 0) {
            search.report(static_cast<double>(now), root.cover());
        } else {
            search.restart(static_cast<double>(now), root.cover());
        }
        if (leasts.empty() || now < leasts.back()) bound.multipliers = search.best();
        leasts.push_back(leasts.empty() ? now : std::min(leasts.back(), now));
        bound.value = std::min(bound.value, std::max(limits.cut, cells.whole(leasts.back())));
        root.ruleOut(cut);
        progress.advance(1);
        noteProgress(problem, limits.cut, bound.value, progress);
        if (isGood(bound, limits) || round == limits.rounds) break;
        // Slower than this it leads nowhere.
        const std::size_t done = leasts.size();
        if (done > kRoundsToJudge && leasts.back() < cells.most(problem.totalWeight()) &&
            (leasts[done - 1 - kRoundsToJudge] - leasts.back()) * 20 < leasts.back() - cut)
            break;
        root.widen(working);
        for (int trial = 0; trial < kTrials; ++trial) {
            const std::uint64_t value = root.evaluate(search.trial(), false);
            search.report(static_cast<double>(value), root.cover());
        }
    }
    bound.survivors = root.survivors();
    progress.end();
    return bound;
}

Bound boundByLagrange(const Problem& problem, const Solution& best, double gap,
                      Progress& progress) {
    return boundWithin(problem, best.chosen, {.cut = best.value, .gap = gap}, progress);
}

}  // namespace ispace
