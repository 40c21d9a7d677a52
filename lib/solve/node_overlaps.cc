// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/node_overlaps.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace ispace {

bool NodeOverlaps::isFor(const NodeRelaxation& relaxed) {
    constexpr std::size_t kLeastGroups = 2, kMostPlaces = 40'000;
    if (relaxed.groups().size() < kLeastGroups) return false;
    std::size_t places = 0;
    std::uint16_t least = std::numeric_limits<std::uint16_t>::max();
    for (const OpenGroup& group : relaxed.groups()) {
        if (group.count != 1 || group.list.empty()) return false;
        places += group.list.size();
        least = std::min(least, relaxed.problem().kinds[group.kind].multiplicity);
    }
    const std::vector<std::uint16_t>& needs = relaxed.problem().needs;
    return places <= kMostPlaces &&
           std::all_of(needs.begin(), needs.end(),
                       [least](std::uint16_t need) { return need <= least; });
}

NodeOverlaps::NodeOverlaps(const NodeRelaxation& relaxed,
                           const std::vector<std::uint32_t>& multipliers)
    : problem_(relaxed.problem()), scratch_(problem_.cells()), cover_(problem_.cells()) {
    for (std::size_t g = 0; g < relaxed.groups().size(); ++g) {
        addGroup(relaxed.groups()[g], relaxed.frequencies()[g]);
        variables_.emplace_back().group = g;
    }
    addWorthiest(multipliers);
    for (Group& group : groups_)
        for (Place& place : group.places)
            if (place.is_working) findView(group, place);
    join(relaxed, multipliers);
}

std::uint64_t NodeOverlaps::evaluate(const std::vector<std::uint32_t>& multipliers,
                                     std::uint64_t cut, const Progress& progress) {
    boundOf(multipliers, false, progress);
    setFloors(multipliers, cut);
    const std::uint64_t bound = boundOf(multipliers, true, progress);
    for (Variable& variable : variables_) variable.floor = kNoFloor;
    return bound;
}

/// By what solutions of working candidates are worth.
void NodeOverlaps::setFloors(const std::vector<std::uint32_t>& multipliers, std::uint64_t cut) {
    const std::int64_t wanted = static_cast<std::int64_t>(cut) - static_cast<std::int64_t>(free_);
    for (const std::size_t i : from_root_) {
        Variable& own = variables_[i];
        if (i == from_root_[0]) {
            own.most = own.values;
            own.floor = wanted;
            continue;
        }
        spread(own, multipliers, false, kNoFloor);
        const Variable& parent = variables_[own.parent];
        std::int64_t rest = std::numeric_limits<std::int64_t>::min();
        for (const std::uint32_t q : parent.ranking.order)
            rest = std::max(rest, parent.most[q] - own.gains[q]);
        own.floor = wanted - rest;
    }
}

std::uint64_t NodeOverlaps::evaluateWorking(const std::vector<std::uint32_t>& multipliers) {
    return boundOf(multipliers, false, SilentProgress());
}

std::uint64_t NodeOverlaps::boundOf(const std::vector<std::uint32_t>& multipliers, bool is_all,
                                    const Progress& progress) {
    if (is_all) {
        weigh(multipliers);
    } else {
        const WeightSums sums(multipliers);
        for (Group& group : groups_)
            for (Place& place : group.places) {
                if (!place.is_working) continue;
                std::uint32_t worth = 0;
                for (const CellRun& run : place.runs) worth += sums.of(run);
                place.worth = worth;
            }
    }
    for (std::size_t i = from_root_.size(); i-- > 0;)
        gather(variables_[from_root_[i]], multipliers, is_all, progress);
    if (progress.stopped()) return std::numeric_limits<std::uint64_t>::max();
    for (const std::size_t i : from_root_) {
        Variable& own = variables_[i];
        own.best =
            i == from_root_[0] ? own.ranking.order[0] : own.replies[variables_[own.parent].best];
    }
    setCover();
    free_ = problem_.settled;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
        free_ += problem_.weights[i] - multipliers[i];
    return free_ + static_cast<std::uint64_t>(topOf(variables_[from_root_[0]]));
}

std::vector<std::uint32_t> NodeOverlaps::listOf(const Variable& variable, bool is_all) const {
    const std::vector<Place>& places = groups_[variable.group].places;
    std::vector<std::uint32_t> list;
    for (std::uint32_t p = 0; p < places.size(); ++p)
        if (is_all || places[p].is_working) list.push_back(p);
    return list;
}

void NodeOverlaps::Ranking::assign(const Group& group, const std::vector<std::int64_t>& values,
                                   std::vector<std::uint32_t> list) {
    std::sort(list.begin(), list.end(), [&values](std::uint32_t a, std::uint32_t b) {
        return values[a] != values[b] ? values[a] > values[b] : a < b;
    });
    // By bundle, in the order of their first places.
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> part_of(group.bundles.size(), kNone);
    parts.clear();
    for (const std::uint32_t p : list) {
        std::uint32_t& part = part_of[group.places[p].bundle];
        if (part == kNone) {
            part = static_cast<std::uint32_t>(parts.size());
            parts.push_back({values[p], group.places[p].bundle, 0, 0});
        }
        ++parts[part].end;
    }
    std::uint32_t begin = 0;
    for (Part& part : parts) {
        part.begin = begin;
        begin += part.end;
        part.end = part.begin;
    }
    order.resize(list.size());
    for (const std::uint32_t p : list) order[parts[part_of[group.places[p].bundle]].end++] = p;
    chances.clear();
    for (std::uint32_t i = 0; i < parts.size(); ++i) chances.push_back({parts[i].best, i});
}

/// Chances above the floor, of a sensor beside one that sees at least this.
auto NodeOverlaps::chancesOf(const Group& group, const Ranking& ranking, const MaskedSums& seen,
                             std::int64_t floor) -> std::vector<Chance> {
    std::vector<Chance> chances;
    for (const Chance& chance : ranking.chances) {
        if (chance.most <= floor) break;
        const Ranking::Part& part = ranking.parts[chance.part];
        const std::int64_t most = part.best - seen.of(group.bundles[part.bundle].common);
        if (most > floor) chances.push_back({most, chance.part});
    }
    std::sort(chances.begin(), chances.end(), [](const Chance& a, const Chance& b) {
        return a.most != b.most ? a.most > b.most : a.part < b.part;
    });
    return chances;
}

/// The highest value of a place less what is seen already, or `floor` if that is more.
/// \param place a good one to begin with
std::int64_t NodeOverlaps::bestOf(const Group& group, const Ranking& ranking,
                                  const std::vector<Chance>& chances,
                                  const std::vector<std::int64_t>& values, const MaskedSums& seen,
                                  std::int64_t floor, std::uint32_t& place) {
    std::int64_t best = std::max(floor, values[place] - seen.of(group.places[place].runs));
    for (const Chance& chance : chances) {
        if (chance.most <= best) break;
        const Ranking::Part& part = ranking.parts[chance.part];
        const std::int64_t common = seen.of(group.bundles[part.bundle].common);
        for (std::uint32_t i = part.begin; i < part.end; ++i) {
            const std::uint32_t q = ranking.order[i];
            if (values[q] - common <= best) break;
            const std::int64_t value = values[q] - seen.of(group.places[q].runs);
            if (value <= best) continue;
            best = value;
            place = q;
        }
    }
    return best;
}

/// What one of the places of a variable is worth with the best replies, or at most its floor.
/// \param replies with the chances
std::int64_t NodeOverlaps::findReplies(const Variable& variable, const Place& place,
                                       const std::vector<std::uint32_t>& multipliers,
                                       MaskedSums& seen, Replies& replies) const {
    std::int64_t value = place.worth;
    for (std::size_t i = 0; i < variable.below.size(); ++i) {
        const auto& chances = replies.chances[i];
        replies.gains[i] = chances.empty() ? replies.floors[i] : chances[0].most;
        value += replies.gains[i];
    }
    if (variable.below.empty() || value <= variable.floor) return value;
    seen.assign(place.runs, multipliers.data());
    for (std::size_t i = 0; i < variable.below.size() && value > variable.floor; ++i) {
        const Variable& below = variables_[variable.below[i]];
        const std::int64_t others = value - replies.gains[i];
        replies.gains[i] =
            bestOf(groups_[below.group], below.ranking, replies.chances[i], below.values, seen,
                   std::max(replies.floors[i], variable.floor - others), replies.places[i]);
        value = others + replies.gains[i];
    }
    return value;
}

/// The chances of all places of a bundle.
/// \return at most so much is the best of them worth
std::int64_t NodeOverlaps::findChances(const Variable& variable, const Bundle& bundle,
                                       std::int64_t worth,
                                       const std::vector<std::uint32_t>& multipliers,
                                       MaskedSums& seen, Replies& replies) const {
    std::int64_t value = worth;
    for (std::size_t i = 0; i < variable.below.size(); ++i) {
        replies.gains[i] = topOf(variables_[variable.below[i]]);
        value += replies.gains[i];
    }
    if (variable.below.empty() || value <= variable.floor) return value;
    seen.assign(bundle.common, multipliers.data());
    for (std::size_t i = 0; i < variable.below.size() && value > variable.floor; ++i) {
        const Variable& below = variables_[variable.below[i]];
        const std::int64_t others = value - replies.gains[i];
        replies.floors[i] = std::max(below.spare, variable.floor - others);
        replies.chances[i] =
            chancesOf(groups_[below.group], below.ranking, seen, replies.floors[i]);
        replies.gains[i] =
            replies.chances[i].empty() ? replies.floors[i] : replies.chances[i][0].most;
        value = others + replies.gains[i];
    }
    return value;
}

void NodeOverlaps::setReplies(Variable& variable, std::uint32_t p, const Replies& replies) {
    variable.values[p] = groups_[variable.group].places[p].worth;
    for (std::size_t i = 0; i < variable.below.size(); ++i) {
        Variable& below = variables_[variable.below[i]];
        below.gains[p] = replies.gains[i];
        below.replies[p] = replies.places[i];
        variable.values[p] += replies.gains[i];
    }
}

/// Values up to the floor without a look at what is seen.
/// \return the other places
std::vector<std::uint32_t> NodeOverlaps::findHopeless(Variable& variable,
                                                      const std::vector<std::uint32_t>& list) {
    Group& group = groups_[variable.group];
    Replies most;
    std::int64_t sum = 0;
    for (const std::size_t i : variable.below) {
        most.gains.push_back(topOf(variables_[i]));
        most.places.push_back(variables_[i].ranking.order[0]);
        sum += most.gains.back();
    }
    std::vector<std::uint32_t> others;
    for (const std::uint32_t p : list) {
        if (group.places[p].worth + sum > variable.floor || group.places[p].is_working) {
            findView(group, group.places[p]);
            others.push_back(p);
            continue;
        }
        setReplies(variable, p, most);
        variable.spare = std::max(variable.spare, variable.values[p]);
    }
    return others;
}

/// The values of the places of a variable, with the best replies of those below.
void NodeOverlaps::gather(Variable& variable, const std::vector<std::uint32_t>& multipliers,
                          bool is_all, const Progress& progress) {
    Group& group = groups_[variable.group];
    std::vector<std::uint32_t> list = listOf(variable, is_all);
    variable.values.resize(group.places.size());
    variable.spare = kNoFloor;
    Replies replies;
    for (const std::size_t i : variable.below) {
        variables_[i].gains.resize(group.places.size());
        variables_[i].replies.resize(group.places.size());
        replies.places.push_back(variables_[i].ranking.order[0]);
    }
    replies.gains.resize(replies.places.size());
    replies.chances.resize(replies.places.size());
    replies.floors.assign(replies.places.size(), kNoFloor);
    MaskedSums seen(multipliers.size());
    if (is_all) {
        list = findHopeless(variable, list);
        for (Bundle& bundle : group.bundles) bundle.places.clear();
        for (const std::uint32_t p : list)
            group.bundles[group.places[p].bundle].places.push_back(p);
        for (const Bundle& bundle : group.bundles) {
            std::int64_t worth = kNoFloor;
            for (const std::uint32_t p : bundle.places)
                worth = std::max(worth, group.places[p].worth);
            if (bundle.places.empty()) continue;
            if (progress.stopped()) break;
            const bool is_worth =
                findChances(variable, bundle, worth, multipliers, seen, replies) > variable.floor;
            for (const std::uint32_t p : bundle.places) {
                if (is_worth) findReplies(variable, group.places[p], multipliers, seen, replies);
                setReplies(variable, p, replies);
            }
        }
    } else {
        for (std::size_t i = 0; i < replies.chances.size(); ++i)
            replies.chances[i] = variables_[variable.below[i]].ranking.chances;
        for (const std::uint32_t p : list) {
            findReplies(variable, group.places[p], multipliers, seen, replies);
            setReplies(variable, p, replies);
        }
    }
    variable.ranking.assign(group, variable.values, list);
}

/// What solutions with each place of a variable are worth at most, or `cut` if that is more. Places
/// of the parent that are in none above it do not count.
void NodeOverlaps::spread(Variable& variable, const std::vector<std::uint32_t>& multipliers,
                          bool is_all, std::int64_t cut) {
    const Variable& parent = variables_[variable.parent];
    Group& group = groups_[variable.group];
    Group& above = groups_[parent.group];
    std::vector<std::int64_t> without(parent.most.size());  // this variable
    std::vector<std::uint32_t> list = listOf(parent, is_all);
    std::erase_if(list, [&](std::uint32_t q) { return parent.most[q] <= cut; });
    for (const std::uint32_t q : list) {
        findView(above, above.places[q]);
        without[q] = parent.most[q] - variable.gains[q];
    }
    Ranking ranking;
    ranking.assign(above, without, list);
    variable.most.resize(group.places.size());
    MaskedSums seen(multipliers.size());
    std::uint32_t last = ranking.order[0];
    for (const std::uint32_t p : listOf(variable, is_all)) {
        variable.most[p] = variable.values[p] + ranking.parts[0].best;
        if (variable.most[p] <= cut) continue;
        findView(group, group.places[p]);
        seen.assign(group.places[p].runs, multipliers.data());
        variable.most[p] = variable.values[p] + bestOf(above, ranking, ranking.chances, without,
                                                       seen, cut - variable.values[p], last);
    }
}

void NodeOverlaps::ruleOut(std::uint64_t cut, const std::vector<std::uint32_t>& multipliers) {
    std::vector<std::vector<char>> is_out;
    const std::int64_t wanted = static_cast<std::int64_t>(cut) - static_cast<std::int64_t>(free_);
    for (const Group& group : groups_) is_out.emplace_back(group.places.size(), 0);
    for (const std::size_t i : from_root_) {
        Variable& own = variables_[i];
        if (i == from_root_[0])
            own.most = own.values;
        else
            spread(own, multipliers, true, wanted);
        bool is_any = false;
        for (std::size_t p = 0; p < own.most.size(); ++p) {
            const std::uint64_t most = free_ + static_cast<std::uint64_t>(own.most[p]);
            if (most > cut) {
                is_any = true;
                continue;
            }
            is_out[own.group][p] = 1;
            ruled_out_ = std::max(ruled_out_, most);
        }
        if (!is_any) break;
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        std::size_t kept = 0;
        std::vector<Place>& places = groups_[g].places;
        for (std::size_t p = 0; p < places.size(); ++p) {
            if (is_out[g][p] != 0) continue;
            if (kept != p) places[kept] = std::move(places[p]);
            ++kept;
        }
        places.resize(kept);
        keepOneWorking(groups_[g]);
    }
}

void NodeOverlaps::setCover() {
    std::fill(cover_.begin(), cover_.end(), 0.0F);
    std::vector<char> is_seen;
    for (const Variable& variable : variables_) {
        is_seen.assign(cover_.size(), 0);
        for (const CellRun& run : groups_[variable.group].places[variable.best].runs)
            for (std::uint32_t i = run.first; i < run.end; ++i) {
                cover_[i] += 1.0F;
                is_seen[i] = 1;
            }
        for (const std::size_t i : variable.below) {
            const Variable& below = variables_[i];
            for (const CellRun& run : groups_[below.group].places[below.best].runs)
                for (std::uint32_t cell = run.first; cell < run.end; ++cell)
                    if (is_seen[cell] != 0) cover_[cell] -= 1.0F;
        }
    }
}

}  // namespace ispace
