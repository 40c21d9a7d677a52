// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/lagrange.h"

#include <algorithm>

#include "place/multiplier_search.h"
#include "place/root_relaxation.h"
#include "place/search_notes.h"

namespace ispace {
namespace {

constexpr int kTrials = 20;        // between two looks at all candidates
constexpr int kRoundsToJudge = 4;  // by what these gain
constexpr std::size_t kMostCounts = 32;

bool isGood(const Bound& bound, const LagrangeLimits& limits) {
    return static_cast<double>(bound.value - std::min(bound.value, limits.cut)) <=
           limits.gap * static_cast<double>(bound.value);
}

/// Bounds by number of sensors, from the multipliers found and those that suit fewer sensors.
void boundCounts(RootRelaxation& root, const std::vector<Choice>& near,
                 const std::vector<std::uint32_t>& multipliers, std::vector<std::uint64_t>& counts,
                 const Progress& progress) {
    root.readmitAll();
    root.evaluate(multipliers, true);
    root.lowerByCount(counts);
    for (std::size_t n = 1; n < std::min(near.size(), kMostCounts) && !progress.stopped(); ++n) {
        root.evaluate(root.startFrom({near.begin(), near.begin() + static_cast<long>(n)}), true);
        root.lowerByCount(counts);
    }
}

/// In whole units, and never decreasing: what few sensors are worth, more are worth, too.
std::vector<std::uint64_t> wholeCounts(const RelaxedCells& cells, std::vector<std::uint64_t> counts,
                                       std::uint64_t bound) {
    for (std::size_t n = counts.size(); n-- > 0;) {
        bound = std::min(bound, cells.whole(counts[n]));
        counts[n] = bound;
    }
    return counts;
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
    std::vector<std::uint64_t> counts(sensors + 1, cells.most(bound.value));
    progress.begin("bounding", limits.rounds);
    MultiplierSearch search(cells.weights, bound.multipliers, static_cast<double>(cut));
    std::vector<std::uint64_t> leasts;  // after each round
    for (int round = 0; round <= limits.rounds && !progress.stopped(); ++round) {
        const std::uint64_t now = root.evaluate(round == 0 ? search.trial() : search.best(), true);
        if (round == 0) {
            search.report(static_cast<double>(now), root.cover());
            root.lowerByCount(counts);
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
    if (limits.has_counts) {
        boundCounts(root, near, bound.multipliers, counts, progress);
        bound.by_count = wholeCounts(cells, std::move(counts), bound.value);
    }
    progress.end();
    return bound;
}

Bound boundByLagrange(const Problem& problem, const Solution& best, double gap,
                      Progress& progress) {
    return boundWithin(problem, best.chosen, {.cut = best.value, .gap = gap}, progress);
}

}  // namespace ispace
