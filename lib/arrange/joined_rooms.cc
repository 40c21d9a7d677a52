// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/joined_rooms.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "arrange/measured_scene.h"
#include "arrange/objective.h"
#include "arrange/search/problem.h"
#include "base/error.h"
#include "base/number.h"

namespace ispace {

namespace {

void addShifted(std::span<const CellRun> runs, std::size_t first, CellParts& parts) {
    const auto shift = static_cast<std::uint32_t>(first);
    for (const CellRun& run : runs) parts.runs.push_back({run.first + shift, run.end + shift});
}

void endPart(CellParts& parts) {
    parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
}

}  // namespace

struct JoinedRooms::Data {
    /// The cells of another room that the candidates of a site see.
    struct CellsBeyond {
        std::size_t room = 0;
        CellParts parts;  ///< by candidate
    };
    struct MeasuredRoom {
        std::shared_ptr<const MeasuredScene> model;
        std::vector<std::vector<CellsBeyond>> beyond;  ///< by site
    };

    void build(const SightBetweenRooms& sight, Progress& watch);
    void look(const SightBetweenRooms& sight, std::size_t from, std::size_t site);
    [[nodiscard]] const CandidateSet& setOf(std::size_t room) const {
        return *rooms[room].model->problem().kinds.front().candidates;
    }
    void addSites(std::size_t room, const std::map<std::size_t, std::size_t>& firsts,
                  CandidateSet& joined) const;
    [[nodiscard]] JoinedLayout layoutOf(std::span<const std::size_t> part,
                                        const std::vector<Choice>& chosen) const;

    std::vector<Room> inputs;
    ArrangeOptions options;
    Progress* progress;
    std::vector<MeasuredRoom> rooms;
    bool is_complete = true;
};

void JoinedRooms::Data::look(const SightBetweenRooms& sight, std::size_t from, std::size_t site) {
    const CandidateSet& set = setOf(from);
    const MeasuredScene& model = *rooms[from].model;
    std::vector<Sensor> turned;
    for (std::size_t i = set.firstOf(site); i < set.firstOf(site + 1); ++i)
        turned.push_back({"", model.kinds().front().model, model.poseOf({0, i})});
    for (std::size_t to = 0; to < rooms.size(); ++to) {
        if (to == from || rooms[to].model == nullptr || !sight.maySee(from, turned.front(), to))
            continue;
        CellsBeyond seen{to, {}};
        sight.look(from, turned, to, rooms[to].model->target().grid, seen.parts);
        if (!seen.parts.runs.empty()) rooms[from].beyond[site].push_back(std::move(seen));
    }
}

void JoinedRooms::Data::build(const SightBetweenRooms& sight, Progress& watch) {
    std::map<const Scene*, std::shared_ptr<const MeasuredScene>> known;
    for (const Room& room : inputs) {
        if (room.scene == nullptr) {
            rooms.emplace_back();
            continue;
        }
        auto& model = known[room.scene];
        if (model == nullptr)
            model = std::make_shared<const MeasuredScene>(*room.scene, room.groups, options, watch);
        is_complete = is_complete && model->isComplete();
        rooms.push_back({model, {}});
    }
    std::int64_t sites = 0;
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        if (rooms[i].model != nullptr) rooms[i].beyond.resize(setOf(i).sites());
        sites += std::ssize(rooms[i].beyond);
    }
    watch.begin("looking into other rooms", sites);
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        constexpr std::size_t kAtOnce = 256;
        for (std::size_t first = 0; first < rooms[i].beyond.size(); first += kAtOnce) {
            if (watch.stopped()) {
                is_complete = false;
                break;
            }
            const std::size_t end = std::min(first + kAtOnce, rooms[i].beyond.size());
            tbb::parallel_for(first, end, [&](std::size_t site) {
                // A thread that waits for rows of cells here must not begin with another site.
                tbb::this_task_arena::isolate([&] { look(sight, i, site); });
            });
            watch.advance(static_cast<std::int64_t>(end - first));
        }
    }
    watch.end();
}

JoinedRooms::JoinedRooms(std::vector<Room> rooms, const ArrangeOptions& options,
                         const SightBetweenRooms& sight, Progress& progress)
    : data_(std::make_unique<Data>(Data{std::move(rooms), options, &progress, {}})) {
    // One kind in each room, of any number.
    data_->options.budget = std::numeric_limits<double>::max();
    for (Room& room : data_->inputs)
        for (SensorGroup& group : room.groups) {
            group.whole = group.model;
            limitCovered(group.model, options);
        }
    data_->build(sight, progress);
}

JoinedRooms::~JoinedRooms() = default;

std::vector<std::vector<std::size_t>> JoinedRooms::parts() const {
    std::vector<std::size_t> of(data_->rooms.size());
    std::iota(of.begin(), of.end(), std::size_t{0});
    for (std::size_t from = 0; from < of.size(); ++from)
        for (const auto& site : data_->rooms[from].beyond)
            for (const Data::CellsBeyond& seen : site) {
                const std::size_t low = std::min(of[from], of[seen.room]);
                const std::size_t high = std::max(of[from], of[seen.room]);
                if (low != high) std::replace(of.begin(), of.end(), high, low);
            }
    std::map<std::size_t, std::vector<std::size_t>> by_first;
    for (std::size_t i = 0; i < of.size(); ++i) by_first[of[i]].push_back(i);
    std::vector<std::vector<std::size_t>> parts;
    parts.reserve(by_first.size());
    for (auto& [first, part] : by_first) parts.push_back(std::move(part));
    return parts;
}

std::size_t JoinedRooms::candidates(std::size_t room) const { return data_->setOf(room).size(); }

/// Adds the sites of a room with the cells that they see in all rooms.
/// \param firsts where the cells of each room begin
void JoinedRooms::Data::addSites(std::size_t room, const std::map<std::size_t, std::size_t>& firsts,
                                 CandidateSet& joined) const {
    const CandidateSet& own = setOf(room);
    CellParts parts;
    std::vector<CandidateSet::PartRange> ranges;
    for (std::size_t site = 0; site < own.sites(); ++site) {
        const std::size_t begin = own.firstOf(site), count = own.firstOf(site + 1) - begin;
        parts.runs.clear();
        parts.first.assign(1, 0);
        ranges.clear();
        const std::vector<CellsBeyond>& beyond = rooms[room].beyond[site];
        if (beyond.empty()) {
            for (std::size_t k = 0; k <= own.directedParts(site); ++k) {
                addShifted(own.runsOf(site, k), firsts.at(room), parts);
                endPart(parts);
            }
            for (std::size_t k = 0; k < count; ++k) ranges.push_back(own.rangeOf(begin + k));
        } else {
            for (std::size_t k = 0; k < count; ++k) {
                addShifted(partOf(own.cellsOf(begin + k)).runs, firsts.at(room), parts);
                for (const auto& [to, seen] : beyond)
                    addShifted(std::span(seen.runs).subspan(seen.first[k],
                                                            seen.first[k + 1] - seen.first[k]),
                               firsts.at(to), parts);
                endPart(parts);
                ranges.push_back({static_cast<std::uint32_t>(k), 1});
            }
            endPart(parts);
        }
        joined.addSite(ranges, parts);
        if (joined.bytes() > options.max_bytes)
            throw UsageError("the candidates of rooms that see each other take more than " +
                             formatBytes(options.max_bytes) +
                             ": use fewer places, headings or cells, or --max-memory");
    }
}

JoinedLayout JoinedRooms::Data::layoutOf(std::span<const std::size_t> part,
                                         const std::vector<Choice>& chosen) const {
    JoinedLayout layout;
    std::size_t first = 0;
    for (const std::size_t room : part) {
        const std::size_t end = first + setOf(room).size();
        std::vector<Choice> own;
        for (const Choice& choice : chosen)
            if (choice.candidate >= first && choice.candidate < end)
                own.push_back({0, choice.candidate - first});
        layout.rooms.push_back(rooms[room].model->placementsOf(own));
        first = end;
    }
    return layout;
}

namespace {

/// Returns the sum of these weights of the cells that a choice covers.
double valueByArea(const Problem& problem, const std::vector<double>& weights,
                   const std::vector<Choice>& chosen) {
    std::vector<int> met(problem.cells());
    for (const Choice& choice : chosen)
        problem.kinds.front().candidates->forEachRun(choice.candidate, [&](const CellRun& run) {
            for (std::uint32_t cell = run.first; cell < run.end; ++cell) ++met[cell];
        });
    double value = 0;
    for (std::size_t i = 0; i < met.size(); ++i)
        if (met[i] >= problem.required) value += weights[i];
    return value;
}

/// Chooses unused candidates until there are as many as wanted, if there are.
void fill(std::vector<Choice>& chosen, std::size_t wanted, std::size_t candidates) {
    for (std::size_t i = 0; i < candidates && chosen.size() < wanted; ++i)
        if (std::find(chosen.begin(), chosen.end(), Choice{0, i}) == chosen.end())
            chosen.push_back({0, i});
}

}  // namespace

std::vector<JoinedLayout> JoinedRooms::layouts(std::span<const std::size_t> part, int most) const {
    const Data& data = *data_;
    std::map<std::size_t, std::size_t> firsts;
    std::vector<double> weights;  // m2
    double area = 0;
    for (const std::size_t room : part) {
        const MeasuredScene& model = *data.rooms[room].model;
        const double floor = model.scene().environment.indoor().area();
        const double each = floor / static_cast<double>(model.problem().totalWeight());
        firsts[room] = weights.size();
        for (const std::uint32_t weight : model.problem().weights) weights.push_back(each * weight);
        area += floor;
    }
    // Rounded down; a covered cell counts for its area all the same.
    const double scale = static_cast<double>(std::numeric_limits<std::uint32_t>::max()) / area;
    Problem problem;
    for (const double weight : weights)
        problem.weights.push_back(static_cast<std::uint32_t>((1 - 1e-9) * scale * weight));
    const double rounding =
        std::max(0.0, area - static_cast<double>(problem.totalWeight()) / scale);
    problem.required = data.rooms[part.front()].model->problem().required;
    CandidateSet set(problem.cells());
    for (const std::size_t room : part) data.addSites(room, firsts, set);
    problem.kinds.push_back({&set, 1, 1, 1});
    SearchOptions options = data.options.search;
    const std::size_t taken = std::min(data.options.max_bytes, set.bytes());
    options.max_bytes = std::min(options.max_bytes, data.options.max_bytes - taken);
    std::vector<JoinedLayout> layouts;
    std::vector<Choice> before;
    for (int n = 1; n <= most; ++n) {
        problem.kinds.front().most = n;
        SearchResult found = search(problem, options, *data.progress);
        std::vector<Choice> chosen = std::move(found.best.chosen);
        std::sort(chosen.begin(), chosen.end());
        chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
        // One more sensor never covers less.
        if (valueByArea(problem, weights, chosen) < valueByArea(problem, weights, before))
            chosen = before;
        fill(chosen, static_cast<std::size_t>(n), set.size());
        JoinedLayout& layout = layouts.emplace_back(data.layoutOf(part, chosen));
        layout.value = valueByArea(problem, weights, chosen);
        layout.rounding = rounding;
        const double bound = static_cast<double>(found.bound) / scale + rounding;
        layout.bound = data.is_complete ? std::min(area, bound) : area;
        layout.is_complete = data.is_complete && found.is_complete;
        before = std::move(chosen);
    }
    // A bound for n sensors holds for fewer.
    for (std::size_t i = layouts.size(); i-- > 1;)
        layouts[i - 1].bound = std::min(layouts[i - 1].bound, layouts[i].bound);
    return layouts;
}

}  // namespace ispace
