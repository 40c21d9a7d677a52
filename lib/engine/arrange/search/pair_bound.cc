// SPDX-License-Identifier: GPL-3.0-or-later
// One evaluation of the overlap bound: from the leaves of the tree of areas to its root, the best
// value of an area for each candidate that it might begin with; then the choice back from the root.
//
// Views are bundled, so that one sum over the cells common to a bundle excludes most of its
// members. Sums are whole numbers; an area with three sensors or more is bounded by the union of
// its views.
#include "arrange/search/pair_bound.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

namespace ispace {

/// Returns the bundles and the members of each, sorted by this value.
template <typename Value>
void OverlapRelaxation::sortBundles(Area& area, Value value) const {
    for (Bundle& bundle : area.bundles) bundle.ranks.clear();
    area.bundle_order.clear();
    for (const std::uint32_t rank : area.order) {
        const std::uint32_t i = bundle_of_[view_of_[area.places[rank].candidate]];
        Bundle& bundle = area.bundles[i];
        if (bundle.ranks.empty()) {
            area.bundle_order.push_back(i);
            bundle.best = value(area.places[rank]);
        }
        bundle.ranks.push_back(rank);
    }
}

std::uint64_t OverlapRelaxation::evaluate(const std::vector<std::uint32_t>& multipliers,
                                          const Progress& progress) {
    return boundOf(multipliers, true, progress);
}

std::uint64_t OverlapRelaxation::evaluateWorking(const std::vector<std::uint32_t>& multipliers,
                                                 const Progress& progress) {
    return boundOf(multipliers, false, progress);
}

std::uint64_t OverlapRelaxation::boundOf(const std::vector<std::uint32_t>& multipliers, bool is_all,
                                         const Progress& progress) {
    constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
    constexpr std::size_t kMaxViews = 200'000;
    number_ = std::int64_t{multipliers.back()} * kNumberUnit;
    findPlaces(multipliers, is_all);
    if (views_.size() > kMaxViews) return kNoLimit;
    for (std::size_t i = from_root_.size(); i-- > 0;) {
        if (progress.stopped()) return kNoLimit;
        gather(areas_[from_root_[i]], multipliers);
    }
    choose();
    setCover();
    std::uint64_t bound = cells_.settled + sensors_ * static_cast<std::uint64_t>(number_);
    for (std::size_t i = 0; i + 1 < multipliers.size(); ++i)
        bound += cells_.weights[i] - multipliers[i];
    return bound + static_cast<std::uint64_t>(areas_[from_root_[0]].value());
}

/// Finds the candidates worth a sensor: the others cannot improve a choice.
void OverlapRelaxation::findPlaces(const std::vector<std::uint32_t>& multipliers, bool is_all) {
    const WeightSums sums(std::span(multipliers.data(), multipliers.size() - 1));
    for (Area& area : areas_) area.places.clear();
    const auto add = [&](Area& area, std::uint32_t i, std::uint32_t weight) {
        if (std::int64_t{weight} <= number_) return;
        Place& place = area.places.emplace_back();
        place.candidate = i;
        place.worth = std::int64_t{weight} - number_;
        viewOf(i);
    };
    if (is_all) {
        set_.weighAll(sums, weights_);
        for (std::uint32_t i = 0; i < set_.size(); ++i)
            if (std::int64_t{weights_[i]} > number_) add(areas_[area_of_[i]], i, weights_[i]);
    } else {
        for (Area& area : areas_)
            for (const std::uint32_t i : area.working) {
                std::uint32_t weight = 0;
                for (const CellRun& run : viewOf(i)) weight += sums.of(run);
                add(area, i, weight);
            }
    }
    for (Area& area : areas_) {
        std::sort(area.places.begin(), area.places.end(), [](const Place& a, const Place& b) {
            return a.worth != b.worth ? a.worth > b.worth : a.candidate < b.candidate;
        });
        findCrowd(area, multipliers);
    }
}

/// Computes the union of the views of an area's candidates.
void OverlapRelaxation::findCrowd(Area& area, const std::vector<std::uint32_t>& multipliers) const {
    std::vector<char> is_seen(cells_.weights.size(), 0);
    for (const Place& place : area.places)
        for (const CellRun& run : seenFrom(place))
            std::fill(is_seen.begin() + run.first, is_seen.begin() + run.end, 1);
    area.all.clear();
    area.crowded = 0;
    for (std::uint32_t i = 0; i < is_seen.size(); ++i) {
        if (is_seen[i] == 0) continue;
        area.crowded += multipliers[i];
        if (!area.all.empty() && area.all.back().end == i)
            ++area.all.back().end;
        else
            area.all.push_back({i, i + 1});
    }
}

/// Computes the maximum worth of a candidate with others of its area. It is the worthiest of them.
void OverlapRelaxation::fillArea(const Area& area, std::size_t rank, const MaskedSums& seen,
                                 Place& place) const {
    std::int64_t second = 0;
    place.second = kNone;
    place.count = 1;
    place.is_crowd = false;
    for (const std::uint32_t i : area.bundle_order) {
        const Bundle& bundle = area.bundles[i];
        const std::int64_t most = std::min(bundle.best, place.worth);
        if (bundle.best <= second) break;
        if (bundle.ranks.back() <= rank || most <= second) continue;
        const std::int64_t common = seen.of(bundle.common);
        if (most - common <= second) continue;
        for (const std::uint32_t other : bundle.ranks) {
            if (area.places[other].worth - common <= second) break;
            if (other <= rank) continue;
            const std::int64_t worth =
                area.places[other].worth - seen.of(seenFrom(area.places[other]));
            if (worth <= second) continue;
            second = worth;
            place.second = other;
        }
    }
    place.value = place.worth + second;
    if (second == 0) return;
    place.count = 2;
    for (std::size_t n = 3; n <= sensors_; ++n) {
        const std::int64_t all = area.crowded - static_cast<std::int64_t>(n) * number_;
        const std::int64_t each = place.worth + static_cast<std::int64_t>(n - 1) * second;
        if (all <= place.value) break;
        if (std::min(all, each) <= place.value) continue;
        place.value = std::min(all, each);
        place.count = n;
        place.is_crowd = all < each;
    }
}

/// Computes the maximum that an area below adds to a sensor with this view, and its candidate.
std::int64_t OverlapRelaxation::reply(const Area& from, const MaskedSums& seen,
                                      std::uint32_t& rank) const {
    std::int64_t best = from.empty;
    for (const std::uint32_t i : from.bundle_order) {
        const Bundle& bundle = from.bundles[i];
        if (bundle.best <= best) break;
        const std::int64_t common = seen.of(bundle.common);
        for (const std::uint32_t own : bundle.ranks) {
            const Place& place = from.places[own];
            if (place.value - common <= best) break;
            const std::int64_t value = place.value - seen.of(seenFrom(place));
            if (value <= best) continue;
            best = value;
            rank = own;
        }
    }
    return best;
}

/// Computes the values of the candidates of an area, with the best replies of the areas below.
void OverlapRelaxation::gather(Area& area, const std::vector<std::uint32_t>& multipliers) {
    area.empty = 0;
    for (const std::size_t i : area.below) area.empty += areas_[i].value();
    area.replies.assign(area.below.size(), std::vector<std::uint32_t>(area.places.size(), kNone));
    area.order.resize(area.places.size());
    std::iota(area.order.begin(), area.order.end(), 0U);
    sortBundles(area, [](const Place& place) { return place.worth; });
    // Iterations are independent, except for the candidates' worth, which is constant here.
    constexpr std::size_t kGrain = 32;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, area.places.size(), kGrain),
                      [&](const tbb::blocked_range<std::size_t>& some) {
                          MaskedSums seen(cells_.weights.size());
                          for (std::size_t rank = some.begin(); rank < some.end(); ++rank) {
                              Place& place = area.places[rank];
                              seen.assign(seenFrom(place), multipliers.data());
                              fillArea(area, rank, seen, place);
                              for (std::size_t i = 0; i < area.below.size(); ++i)
                                  place.value +=
                                      reply(areas_[area.below[i]], seen, area.replies[i][rank]);
                          }
                      });
    std::sort(area.order.begin(), area.order.end(), [&area](std::uint32_t a, std::uint32_t b) {
        const std::int64_t one = area.places[a].value, other = area.places[b].value;
        return one != other ? one > other : a < b;
    });
    sortBundles(area, [](const Place& place) { return place.value; });
}

void OverlapRelaxation::choose() {
    for (const std::size_t i : from_root_) {
        Area& area = areas_[i];
        const bool is_root = i == from_root_[0];
        const std::uint32_t above = is_root ? kNone : areas_[area.parent].best;
        if (above == kNone) {
            const bool is_empty =
                area.order.empty() || area.places[area.order[0]].value <= area.empty;
            area.best = is_empty ? kNone : area.order[0];
            continue;
        }
        const std::vector<std::size_t>& beside = areas_[area.parent].below;
        const auto own =
            static_cast<std::size_t>(std::find(beside.begin(), beside.end(), i) - beside.begin());
        area.best = areas_[area.parent].replies[own][above];
    }
}

void OverlapRelaxation::setCover() {
    std::fill(cover_.begin(), cover_.end(), 0.0F);
    std::size_t chosen = 0;
    std::vector<char> is_seen;
    const auto add = [&](const CellRuns& runs, float part, bool is_new) {
        for (const CellRun& run : runs)
            for (std::uint32_t i = run.first; i < run.end; ++i)
                if (!is_new || is_seen[i] == 0) cover_[i] += part;
    };
    for (const Area& area : areas_) {
        if (area.best == kNone) continue;
        const Place& place = area.places[area.best];
        const CellRuns& own = seenFrom(place);
        is_seen.assign(cover_.size(), 0);
        for (const CellRun& run : own)
            std::fill(is_seen.begin() + run.first, is_seen.begin() + run.end, 1);
        chosen += place.count;
        add(place.is_crowd ? area.all : own, 1.0F, false);
        if (!place.is_crowd && place.second != kNone)
            add(seenFrom(area.places[place.second]), static_cast<float>(place.count - 1), true);
        for (const std::size_t i : area.below) {
            if (areas_[i].best == kNone) continue;
            for (const CellRun& run : seenFrom(areas_[i].places[areas_[i].best]))
                for (std::uint32_t cell = run.first; cell < run.end; ++cell)
                    if (is_seen[cell] != 0) cover_[cell] -= 1.0F;
        }
    }
    cover_.back() = 1.0F + static_cast<float>(kNumberUnit) *
                               (static_cast<float>(sensors_) - static_cast<float>(chosen));
}

namespace {

constexpr std::size_t kMinSensors = 6, kMaxSensors = 64;
constexpr int kTrials = 10;  // between two evaluations of all candidates

}  // namespace

bool isBoundByOverlaps(const Problem& problem) {
    if (problem.kinds.size() != 1) return false;
    const RelaxedCells cells(problem);
    const bool is_single =
        std::all_of(cells.needs.begin(), cells.needs.end(),
                    [&cells](std::uint16_t need) { return need <= cells.multiplicities[0]; });
    const std::size_t sensors = CountChoice(problem).total();
    return is_single && sensors >= kMinSensors && sensors <= kMaxSensors &&
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
