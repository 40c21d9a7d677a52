// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/overlap_bound.h"

#include <algorithm>
#include <limits>

#include "solve/overlap_relaxation.h"

namespace ispace {

namespace {

constexpr std::size_t kLeastSensors = 6, kMostSensors = 64;
constexpr int kTrials = 10;     // between two evaluations of all candidates
constexpr int kRoundsBack = 4;  // by what these gain

}  // namespace

bool isBoundByOverlaps(const Problem& problem) {
    if (problem.kinds.size() != 1) return false;
    const RelaxedCells cells(problem);
    const bool is_single =
        std::all_of(cells.needs.begin(), cells.needs.end(),
                    [&cells](std::uint16_t need) { return need <= cells.multiplicities[0]; });
    const std::size_t sensors = CountChoice(problem).total();
    return is_single && sensors >= kLeastSensors && sensors <= kMostSensors &&
           problem.kinds[0].candidates->size() > sensors;
}

std::uint64_t overlapBound(const Problem& problem, const Bound& plain,
                           const std::vector<Choice>& near, const LagrangeLimits& limits,
                           Progress& progress) {
    if (!isBoundByOverlaps(problem) || near.empty()) return plain.value;
    progress.begin("bounding overlaps", limits.rounds);
    OverlapRelaxation relaxed(problem, plain, near);
    const std::uint64_t cut = relaxed.cells().most(limits.cut);
    MultiplierSearch search(relaxed.limits(), relaxed.start(), static_cast<double>(cut),
                            limits.pace);
    std::vector<std::uint64_t> leasts;  // after each round
    std::uint64_t bound = plain.value;
    for (int round = 0; round < limits.rounds && !progress.stopped(); ++round) {
        const std::uint64_t now =
            relaxed.evaluate(round == 0 ? search.trial() : search.best(), progress);
        if (now == std::numeric_limits<std::uint64_t>::max()) break;
        if (round == 0)
            search.report(static_cast<double>(now), relaxed.cover());
        else
            search.restart(static_cast<double>(now), relaxed.cover());
        leasts.push_back(leasts.empty() ? now : std::min(leasts.back(), now));
        bound = std::min(bound, std::max(limits.cut, relaxed.cells().whole(leasts.back())));
        progress.advance(1);
        noteProgress(problem, limits.cut, bound, progress);
        if (static_cast<double>(bound - limits.cut) <= limits.gap * static_cast<double>(bound))
            break;
        const std::size_t done = leasts.size();
        if (done > kRoundsBack && leasts.back() > cut &&
            static_cast<double>(leasts[done - 1 - kRoundsBack] - leasts.back()) <
                limits.stall * static_cast<double>(leasts.back() - cut))
            break;
        relaxed.widen();
        for (int trial = 0; trial < kTrials && !progress.stopped(); ++trial)
            search.report(static_cast<double>(relaxed.evaluateWorking(search.trial(), progress)),
                          relaxed.cover());
    }
    progress.end();
    return bound;
}

}  // namespace ispace
