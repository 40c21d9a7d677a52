// SPDX-License-Identifier: GPL-3.0-or-later
// The areas of overlapBound(): candidates about the sensors of a solution, bundled by similar views
// and joined in a tree, the spanning tree of most overlap (R. C. Prim, Shortest connection networks
// and some generalizations, 1957). Any tree gives a valid bound; one of much overlap subtracts
// much.
#include <algorithm>
#include <functional>
#include <limits>

#include "arrange/search/pair_bound.h"

namespace ispace {

namespace {

/// Returns the weight of the n-th best.
std::uint32_t nthOf(std::vector<std::uint32_t> weights, std::size_t n) {
    const auto at = weights.begin() + static_cast<std::ptrdiff_t>(n - 1);
    std::nth_element(weights.begin(), at, weights.end(), std::greater<>());
    return *at;
}

/// Finds by candidate the sensor of a good solution with the most similar view by these
/// multipliers, the first among equals. O(sensors * runs)
std::vector<std::uint32_t> areasAbout(const CandidateSet& set, const std::vector<Choice>& near,
                                      const std::vector<std::uint32_t>& multipliers) {
    std::vector<std::uint32_t> areas(set.size(), 0), most(set.size(), 0), weights(set.size());
    for (std::uint32_t area = 0; area < near.size(); ++area) {
        std::vector<std::uint32_t> seen(multipliers.size(), 0);
        set.forEachRun(near[area].candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i) seen[i] = multipliers[i];
        });
        set.weighAll(WeightSums(seen), weights);
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (weights[i] <= most[i]) continue;
            most[i] = weights[i];
            areas[i] = area;
        }
    }
    return areas;
}

}  // namespace

OverlapRelaxation::OverlapRelaxation(const Problem& problem, const Bound& plain,
                                     const std::vector<Choice>& near)
    : cells_(problem),
      set_(*problem.kinds[0].candidates),
      sensors_(CountChoice(problem).total()),
      view_of_(set_.size(), kNone),
      seen_(problem.cells()),
      weights_(set_.size()),
      limits_(cells_.weights),
      start_(plain.multipliers),
      area_of_(areasAbout(set_, near, plain.multipliers)),
      cover_(problem.cells() + 1) {
    areas_.resize(near.size());
    set_.weighAll(WeightSums(start_), weights_);
    const std::uint32_t least = nthOf(weights_, sensors_);
    join(least);
    // As many candidates exceed it as there are sensors.
    start_.push_back(least / kNumberUnit);
    limits_.push_back(std::numeric_limits<std::uint32_t>::max() / kNumberUnit);
}

/// Prim's algorithm for the spanning tree of most overlap between promising candidates.
/// \param least the weight of the least of as many candidates as there are sensors
void OverlapRelaxation::join(std::uint32_t least) {
    constexpr double kPromising = 0.98;
    const std::size_t cells = start_.size();
    std::vector<std::vector<float>> cover(areas_.size(), std::vector<float>(cells, 0.0F));
    std::vector<float> counts(areas_.size(), 0.0F);
    for (std::size_t i = 0; i < set_.size(); ++i) {
        if (static_cast<double>(weights_[i]) < kPromising * static_cast<double>(least)) continue;
        counts[area_of_[i]] += 1.0F;
        set_.forEachRun(i, [&](const CellRun& run) {
            for (std::uint32_t cell = run.first; cell < run.end; ++cell)
                cover[area_of_[i]][cell] += 1.0F;
        });
    }
    const auto overlap = [&](std::size_t a, std::size_t b) {
        double sum = 0;
        for (std::size_t i = 0; i < cells; ++i)
            sum += static_cast<double>(static_cast<float>(start_[i]) * cover[a][i] * cover[b][i]);
        return sum / static_cast<double>(std::max(counts[a] * counts[b], 1.0F));
    };
    from_root_ = {0};
    std::vector<double> nearest(areas_.size(), -1);
    std::vector<std::size_t> to(areas_.size(), 0);
    std::vector<char> is_joined(areas_.size(), 0);
    is_joined[0] = 1;
    while (from_root_.size() < areas_.size()) {
        std::size_t next = areas_.size();
        for (std::size_t i = 0; i < areas_.size(); ++i) {
            if (is_joined[i] != 0) continue;
            const double now = overlap(i, from_root_.back());
            if (now > nearest[i]) {
                nearest[i] = now;
                to[i] = from_root_.back();
            }
            if (next == areas_.size() || nearest[i] > nearest[next]) next = i;
        }
        is_joined[next] = 1;
        areas_[next].parent = to[next];
        areas_[to[next]].below.push_back(next);
        from_root_.push_back(next);
    }
}

auto OverlapRelaxation::viewOf(std::uint32_t candidate) -> const CellRuns& {
    if (view_of_[candidate] != kNone) return views_[view_of_[candidate]];
    view_of_[candidate] = static_cast<std::uint32_t>(views_.size());
    views_.push_back(runsOf(set_, candidate));
    addToBundle(candidate);
    return views_.back();
}

void OverlapRelaxation::addToBundle(std::uint32_t candidate) {
    constexpr double kLike = 0.8, kMinValue = 0.7;
    const CellRuns& view = views_.back();
    seen_.assign(view, cells_.weights.data());
    const auto own = static_cast<double>(seen_.of(view));
    std::vector<Bundle>& bundles = areas_[area_of_[candidate]].bundles;
    std::size_t best = bundles.size();
    double most = 0;
    for (std::size_t i = 0; i < bundles.size(); ++i) {
        const auto common = static_cast<double>(seen_.of(bundles[i].common));
        if (common < kLike * own || common < kMinValue * static_cast<double>(bundles[i].founder) ||
            common <= most)
            continue;
        best = i;
        most = common;
    }
    bundle_of_.push_back(static_cast<std::uint32_t>(best));
    if (best == bundles.size()) {
        bundles.push_back({view, static_cast<std::uint64_t>(own), {}, 0});
        return;
    }
    bundles[best].common = commonOf(view, bundles[best].common);
}

void OverlapRelaxation::widen() {
    constexpr std::size_t kMaxPlaces = 40, kHeavy = 250;
    for (std::size_t i = 0; i < areas_.size(); ++i) {
        Area& area = areas_[i];
        for (std::size_t n = 0; n < std::min(kMaxPlaces, area.order.size()); ++n) {
            const Place& place = area.places[area.order[n]];
            area.working.push_back(place.candidate);
            if (place.second != kNone) area.working.push_back(area.places[place.second].candidate);
            for (std::size_t below = 0; below < area.below.size(); ++below) {
                const std::uint32_t reply = area.replies[below][area.order[n]];
                Area& other = areas_[area.below[below]];
                if (reply != kNone) other.working.push_back(other.places[reply].candidate);
            }
        }
        if (area.best != kNone) area.working.push_back(area.places[area.best].candidate);
    }
    std::vector<std::vector<std::uint32_t>> own(areas_.size());
    for (std::uint32_t i = 0; i < set_.size(); ++i) own[area_of_[i]].push_back(i);
    for (std::size_t i = 0; i < areas_.size(); ++i) {
        const std::size_t count = std::min(kHeavy, own[i].size());
        std::partial_sort(own[i].begin(), own[i].begin() + static_cast<std::ptrdiff_t>(count),
                          own[i].end(), [this](std::uint32_t a, std::uint32_t b) {
                              return weights_[a] != weights_[b] ? weights_[a] > weights_[b] : a < b;
                          });
        areas_[i].working.insert(areas_[i].working.end(), own[i].begin(),
                                 own[i].begin() + static_cast<std::ptrdiff_t>(count));
    }
    for (Area& area : areas_) {
        std::sort(area.working.begin(), area.working.end());
        area.working.erase(std::unique(area.working.begin(), area.working.end()),
                           area.working.end());
    }
}

}  // namespace ispace
