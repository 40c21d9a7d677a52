// SPDX-License-Identifier: GPL-3.0-or-later
// Which candidates of a node are looked at, and what of them see much the same.
#include <algorithm>
#include <numeric>

#include "solve/node_overlaps.h"

namespace ispace {

void NodeOverlaps::addWorthiest(const std::vector<std::uint32_t>& multipliers) {
    constexpr std::size_t kMost = 60;
    weigh(multipliers);
    for (Group& group : groups_) {
        std::vector<std::uint32_t> list(group.places.size());
        std::iota(list.begin(), list.end(), 0U);
        const auto end = list.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, list.size()));
        std::partial_sort(list.begin(), end, list.end(), [&group](auto a, auto b) {
            return group.places[a].worth != group.places[b].worth
                       ? group.places[a].worth > group.places[b].worth
                       : a < b;
        });
        for (auto at = list.begin(); at != end; ++at) {
            group.places[*at].is_working = true;
            findView(group, group.places[*at]);
        }
    }
}

/// All that were working may be ruled out before others are.
void NodeOverlaps::keepOneWorking(Group& group) {
    std::vector<Place>& places = group.places;
    const auto is_working = [](const Place& place) { return place.is_working; };
    if (places.empty() || std::any_of(places.begin(), places.end(), is_working)) return;
    Place& worthiest =
        *std::max_element(places.begin(), places.end(),
                          [](const Place& a, const Place& b) { return a.worth < b.worth; });
    worthiest.is_working = true;
    findView(group, worthiest);
}

void NodeOverlaps::weigh(const std::vector<std::uint32_t>& multipliers) {
    const WeightSums sums(multipliers);
    std::vector<std::uint32_t> worths;
    for (Group& group : groups_) {
        const CandidateSet& set = *problem_.kinds[group.kind].candidates;
        std::size_t last = set.sites();
        for (Place& place : group.places) {
            const std::size_t site = set.siteOf(place.candidate);
            if (site != last) {
                worths.resize(set.firstOf(site + 1) - set.firstOf(site));
                set.weighSite(site, sums, worths);
                last = site;
            }
            place.worth = worths[place.candidate - set.firstOf(site)];
        }
    }
}

void NodeOverlaps::addGroup(const OpenGroup& group, const std::vector<float>& frequencies) {
    Group& own = groups_.emplace_back();
    own.kind = group.kind;
    own.places.resize(group.list.size());
    for (std::size_t i = 0; i < group.list.size(); ++i) {
        own.places[i].candidate = group.list[i];
        own.places[i].is_working = frequencies[i] > 0;
    }
}

/// Made when it is first needed: most places are ruled out by their worth alone.
void NodeOverlaps::findView(Group& group, Place& place) {
    if (place.has_view) return;
    place.runs = runsOf(*problem_.kinds[group.kind].candidates, place.candidate);
    place.has_view = true;
    addToBundle(group, place, scratch_, problem_.weights);
}

/// Candidates follow each other from place to place, so the last bundles are those nearby.
void NodeOverlaps::addToBundle(Group& group, Place& place, MaskedSums& sums,
                               const std::vector<std::uint32_t>& weights) {
    constexpr double kLike = 0.8, kLeast = 0.7;
    constexpr std::size_t kLast = 48;
    sums.assign(place.runs, weights.data());
    const auto own = static_cast<double>(sums.of(place.runs));
    std::vector<Bundle>& bundles = group.bundles;
    std::size_t best = bundles.size();
    double most = 0;
    for (std::size_t i = bundles.size() - std::min(bundles.size(), kLast); i < bundles.size();
         ++i) {
        const auto most_common = static_cast<double>(bundles[i].weight);
        if (most_common < kLike * own || most_common <= most) continue;
        const auto common = static_cast<double>(sums.of(bundles[i].common));
        if (common < kLike * own || common < kLeast * static_cast<double>(bundles[i].founder) ||
            common <= most)
            continue;
        best = i;
        most = common;
    }
    place.bundle = static_cast<std::uint32_t>(best);
    if (best == bundles.size()) {
        const auto weight = static_cast<std::uint64_t>(own);
        bundles.push_back({place.runs, weight, weight});
        return;
    }
    bundles[best].common = commonOf(place.runs, bundles[best].common);
    bundles[best].weight = static_cast<std::uint64_t>(most);
}

/// Prim's algorithm for the spanning tree of most overlap by the relaxation.
void NodeOverlaps::join(const NodeRelaxation& relaxed,
                        const std::vector<std::uint32_t>& multipliers) {
    const std::size_t cells = problem_.cells();
    std::vector<std::vector<float>> covers;  // by one sensor of each group
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        std::vector<float>& cover = covers.emplace_back(cells, 0.0F);
        const std::vector<float>& frequencies = relaxed.frequencies()[g];
        const float total = std::accumulate(frequencies.begin(), frequencies.end(), 1e-9F);
        for (std::size_t i = 0; i < groups_[g].places.size(); ++i) {
            if (!(frequencies[i] > 0)) continue;
            // Those of no frequency have no view as yet.
            for (const CellRun& run : groups_[g].places[i].runs)
                for (std::uint32_t cell = run.first; cell < run.end; ++cell)
                    cover[cell] += frequencies[i] / total;
        }
    }
    const auto overlap = [&](std::size_t a, std::size_t b) {
        const auto &one = covers[variables_[a].group], &other = covers[variables_[b].group];
        double sum = 0;
        for (std::size_t i = 0; i < cells; ++i)
            sum += static_cast<double>(static_cast<float>(multipliers[i]) * one[i] * other[i]);
        return sum;
    };
    from_root_ = {0};
    std::vector<double> nearest(variables_.size(), -1);
    std::vector<char> is_joined(variables_.size(), 0);
    is_joined[0] = 1;
    while (from_root_.size() < variables_.size()) {
        std::size_t next = variables_.size();
        for (std::size_t i = 0; i < variables_.size(); ++i) {
            if (is_joined[i] != 0) continue;
            const double now = overlap(i, from_root_.back());
            if (now > nearest[i]) {
                nearest[i] = now;
                variables_[i].parent = from_root_.back();
            }
            if (next == variables_.size() || nearest[i] > nearest[next]) next = i;
        }
        is_joined[next] = 1;
        variables_[variables_[next].parent].below.push_back(next);
        from_root_.push_back(next);
    }
}

void NodeOverlaps::widen() {
    constexpr std::size_t kMost = 60;
    for (const Variable& variable : variables_) {
        std::vector<Place>& places = groups_[variable.group].places;
        places[variable.best].is_working = true;
        std::vector<std::uint32_t> list = variable.ranking.order;
        const auto end = list.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, list.size()));
        std::partial_sort(list.begin(), end, list.end(), [&variable](auto a, auto b) {
            return variable.values[a] != variable.values[b]
                       ? variable.values[a] > variable.values[b]
                       : a < b;
        });
        for (auto at = list.begin(); at != end; ++at) {
            places[*at].is_working = true;
            for (const std::size_t i : variable.below)
                groups_[variables_[i].group].places[variables_[i].replies[*at]].is_working = true;
        }
    }
}

bool NodeOverlaps::isClosed() const {
    return std::any_of(groups_.begin(), groups_.end(),
                       [](const Group& group) { return group.places.empty(); });
}

std::vector<std::vector<std::uint32_t>> NodeOverlaps::lists() const {
    std::vector<std::vector<std::uint32_t>> lists;
    for (const Group& group : groups_) {
        std::vector<std::uint32_t>& list = lists.emplace_back();
        for (const Place& place : group.places) list.push_back(place.candidate);
    }
    return lists;
}

}  // namespace ispace
