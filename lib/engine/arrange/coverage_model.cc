// SPDX-License-Identifier: GPL-3.0-or-later
// Builds the coverage problem of a site, and maps its solutions back.
//
// The cells of the problem are those of the rooms, one room after another. A search in several
// cases repeats them: a Copy is the block of a room's cells for one case, or for one set of failed
// sensors, and a candidate's runs are shifted to each copy that it sees. Rooms that see each other
// are joined candidate by candidate (Joiner): runs in other rooms are added to those in its room. A
// room alone has no copies, and its candidates are used as they were made.
#include "arrange/coverage_model.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "arrange/beam_cells.h"
#include "arrange/candidate.h"
#include "arrange/objective.h"
#include "arrange/refine.h"
#include "arrange/search/problem.h"
#include "arrange/sensor_group.h"
#include "base/error.h"
#include "base/number.h"
#include "scene/sensor/ultrasound.h"
#include "sense/scan.h"

namespace ispace {

namespace {

std::vector<SensorModel> devicesOf(const std::vector<SensorClass>& kinds) {
    std::vector<SensorModel> devices;
    devices.reserve(kinds.size());
    for (const SensorClass& kind : kinds) devices.push_back(kind.model);
    return devices;
}

/// Appends the blocks of a room's cells: squares of a grid.
void addBlocks(const Grid& grid, std::size_t cells, std::vector<std::uint32_t>& blocks) {
    constexpr std::size_t kEdge = 6;  // cells; measured: smaller ones bound hardly better
    const std::size_t first = blocks.empty() ? 0 : std::size_t{blocks.back()} + 1;
    const auto columns = static_cast<std::size_t>(grid.columns);
    const std::size_t in_row = (columns + kEdge - 1) / kEdge;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const std::size_t block = cell / columns / kEdge * in_row + cell % columns / kEdge;
        blocks.push_back(static_cast<std::uint32_t>(first + block));
    }
}

}  // namespace

CoverageModel::CoverageModel(const ArrangeSite& site, const std::vector<SensorGroup>& groups,
                             const ArrangeOptions& options, Progress& progress)
    : site_(site),
      groups_(groups),
      options_(options),
      kinds_(kindsOf(groups, drawsForEach(options))) {
    mustBeAffordable();
    if (options.refine)
        for (const SiteRoom& room : site.rooms)
            if (room.has_floor) mustBeRefinable(*room.scene, devicesOf(kinds_), room.goals.weights);
    setUnits();
    addRooms();
    if (options.cases) stackCases();
    if (options.objective) {
        objective_ = options.objective->searchIn(*this);
        total_ = objective_->total();
    }
    const std::vector<std::uint32_t> left = weightsLeft();
    for (Room& room : rooms_) {
        if (room.model == nullptr || room.model->hasPool()) continue;
        std::vector<std::uint32_t> own(room.cells);
        // Backwards: of cells that stand several times the first weight counts.
        for (auto copy = room.copies.rbegin(); copy != room.copies.rend(); ++copy)
            std::copy_n(left.begin() + static_cast<std::ptrdiff_t>(copy->first),
                        copy->own.end - copy->own.first,
                        own.begin() + static_cast<std::ptrdiff_t>(copy->own.first));
        room.model->makePool(std::move(own), progress);
    }
    addKinds(progress);
    if (options.is_connected) addRegions();
}

CoverageModel::~CoverageModel() = default;

void CoverageModel::mustBeAffordable() const {
    if (!options_.budget) return;
    double least = kinds_.front().cost;
    for (const SensorClass& kind : kinds_) least = std::min(least, kind.cost);
    if (*options_.budget < least)
        throw UnmetError("a budget of " + formatDouble(*options_.budget) +
                         " buys nothing: the cheapest sensor costs " + formatDouble(least));
}

/// Four receivers count as one sensor; in the presence of receivers, others have multiplicity 4.
void CoverageModel::setUnits() {
    const auto is_partial = [](const auto& sensor) { return isPartial(sensor.model); };
    const bool listens =
        std::any_of(kinds_.begin(), kinds_.end(), is_partial) ||
        std::any_of(site_.rooms.begin(), site_.rooms.end(), [&](const SiteRoom& room) {
            return std::any_of(room.scene->sensors.begin(), room.scene->sensors.end(), is_partial);
        });
    unit_ = listens ? static_cast<int>(kMinReceivers) : 1;
    problem_.required = unit_ * options_.redundancy;
    problem_.is_connected = options_.is_connected;
    problem_.budget = options_.budget;
}

/// Lays the cells of all rooms one after another. If all are of one size, weights stay as the
/// options give them; else cells count by area.
void CoverageModel::addRooms() {
    std::map<const Scene*, std::shared_ptr<RoomModel>> known;
    std::vector<double> weights, areas;  // areas: by room
    for (const SiteRoom& room : site_.rooms) {
        Room& added = rooms_.emplace_back();
        added.seen.resize(site_.rooms.size());
        areas.push_back(0);
        if (!room.has_floor) continue;
        std::shared_ptr<RoomModel> own;
        // Rooms that are equal here may differ in other sites.
        const bool is_shared = room.goals.isPlain() && !hasSites();
        std::shared_ptr<RoomModel>& model = is_shared ? known[room.scene.get()] : own;
        if (model == nullptr) model = std::make_shared<RoomModel>(room, options_, kinds_, unit_);
        added.model = model;
        added.cells = model->weights().size();
        added.copies = {{{0, added.cells}, weights.size()}};
        areas.back() = model->areaOfCell();
        addBlocks(model->target().grid, added.cells, problem_.blocks);
        weights.insert(weights.end(), model->weights().begin(), model->weights().end());
        problem_.achieved.insert(problem_.achieved.end(), model->achieved().begin(),
                                 model->achieved().end());
    }
    const double most = *std::max_element(areas.begin(), areas.end());
    if (std::all_of(areas.begin(), areas.end(),
                    [most](double area) { return area == 0 || area == most; })) {
        // All cells are equal, as those of one room are.
        problem_.weights = integerWeights(weights);
    } else {
        for (std::size_t i = 0; i < rooms_.size(); ++i)
            for (std::size_t k = 0; k < rooms_[i].cells; ++k)
                weights[rooms_[i].copies.front().first + k] *= areas[i];
        setAreas(std::move(weights));
    }
    if (options_.demand) setNeeds();
    total_ = problem_.totalWeight();
    if (total_ == 0)
        throw UnmetError(options_.demand ? options_.demand->nothingText() : nothingText());
    problem_.standing = CellSet(problem_.cells());
    for (const Room& room : rooms_)
        if (room.model != nullptr)
            room.model->standing().forEach(
                [&](std::size_t cell) { problem_.standing.set(room.copies.front().first + cell); });
    if (joinsRooms() && !hasSites()) countStandingBeyond(0, standingIn(caseOf(site_)));
}

/// Gives each element of a demand the number of sensors that it needs.
void CoverageModel::setNeeds() {
    std::vector<std::uint16_t> needs;  // of all elements
    for (std::size_t i = 0; i < rooms_.size(); ++i) {
        if (rooms_[i].model == nullptr) continue;
        const std::vector<std::uint16_t> own = site_.rooms[i].goals.demand->needs();
        assert(own.empty() || own.size() == rooms_[i].cells);
        needs.insert(needs.end(), own.begin(), own.end());
        if (own.empty()) needs.resize(needs.size() + rooms_[i].cells, 1);
    }
    // The problem requires the same of all: those that need fewer have the difference already.
    const int most = needs.empty() ? 1 : *std::ranges::max_element(needs);
    const int once = problem_.required;
    problem_.required = once * most;
    for (std::size_t i = 0; i < needs.size(); ++i)
        problem_.achieved[i] = static_cast<std::uint16_t>(
            std::min(problem_.achieved[i] + (most - needs[i]) * once, 0xffff));
}

void CoverageModel::setAreas(std::vector<double> areas) {
    const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
    problem_.weights.assign(areas.size(), 0);
    if (!(all > 0)) return;
    // Copies of cells for failures need room for their weights.
    const double most = options_.cases && options_.cases->failures()
                            ? 1 << 25
                            : std::numeric_limits<std::uint32_t>::max();
    const double scale = (1 - 1e-9) * most / all;
    for (std::size_t i = 0; i < areas.size(); ++i)
        problem_.weights[i] = static_cast<std::uint32_t>(scale * areas[i]);
    rounding_ = 1 - static_cast<double>(problem_.totalWeight()) / (scale * all);
    for (double& area : areas) area /= all;
    areas_ = std::move(areas);
}

std::vector<SiteSensor> CoverageModel::standingIn(const SiteCase& site) const {
    std::vector<SiteSensor> standing;
    for (std::size_t room = 0; room < rooms_.size(); ++room)
        for (const Sensor& sensor : site.rooms[room]->sensors) {
            standing.push_back(SiteSensor{room, sensor});
            limitCovered(standing.back().sensor.model, options_);
        }
    return standing;
}

/// Counts them as candidates would be.
void CoverageModel::countStandingBeyond(std::size_t number, std::span<const SiteSensor> standing) {
    for (const auto& [room, sensor] : standing) {
        if (!kindOf(sensor.model).perceives || isPartial(sensor.model)) continue;
        CellSet cells(problem_.cells());
        addBeyond(number, room, sensor, cells);
        cells.forEach([&](std::size_t cell) {
            problem_.achieved[cell] =
                static_cast<std::uint16_t>(std::min(problem_.achieved[cell] + unit_, 0xffff));
        });
        problem_.standing |= cells;
    }
}

/// Explains why no floor counts.
/// \pre all cells weigh 0
std::string CoverageModel::nothingText() const {
    const bool is_weight =
        std::any_of(site_.rooms.begin(), site_.rooms.end(), [this](const SiteRoom& room) {
            if (!room.has_floor || !room.goals.counts) return false;
            const RoomModel& model =
                *rooms_[static_cast<std::size_t>(&room - site_.rooms.data())].model;
            FloorWeights weights = room.goals.weights;
            weights.weights.clear();
            const std::vector<double> unweighted = weightsOfCells(model.target(), weights);
            return std::any_of(unweighted.begin(), unweighted.end(),
                               [](double cell) { return cell > 0; });
        });
    return is_weight ? "nothing to cover: all of the target weighs 0 (--weight)"
                     : "nothing to cover: no cell of the target lies indoors; use a larger zone or "
                       "smaller cells (--cell)";
}

bool CoverageModel::joinsRooms() const {
    const auto joins = [](const RoomSight* sight) {
        return sight != nullptr && sight->joinsRooms();
    };
    return (joins(site_.sight) ||
            std::any_of(case_sights_.begin(), case_sights_.end(),
                        [&](const auto& sight) { return joins(sight.get()); })) &&
           !options_.demand && (!options_.objective || options_.objective->joinsRooms());
}

bool CoverageModel::mayStand(const SensorClass& kind, std::size_t room) const {
    if (rooms_[room].model == nullptr) return false;
    if (kind.room) return *kind.room == room;
    const RoomGoals& goals = site_.rooms[room].goals;
    return goals.takes_sensors && (goals.counts || joinsRooms());
}

Sensor CoverageModel::mountedIn(std::size_t number, std::size_t room, Sensor sensor) const {
    if (view_cases_ == 0 || sensor.mount || sensor.person) return sensor;
    if (rooms_[room].model != nullptr)
        return rooms_[room].model->cases()[number]->mounted(std::move(sensor));
    const auto errors =
        options_.cases->errorsIn(site_.rooms[room].scene->environment, room, number);
    if (errors != nullptr) sensor.pose = errors->actual(sensor);
    return sensor;
}

bool CoverageModel::sees(const RoomSight& sight, std::size_t from, const Sensor& sensor,
                         std::size_t to) const {
    return to != from && rooms_[to].model != nullptr && sight.maySee(from, sensor, to);
}

void CoverageModel::addBeyond(std::size_t number, std::size_t room, const Sensor& sensor,
                              CellSet& cells) const {
    const Sensor mounted = mountedIn(number, room, sensor);
    for (std::size_t to = 0; to < rooms_.size(); ++to) {
        if (!sees(sightIn(number), room, mounted, to)) continue;
        CellParts seen;
        sightIn(number).look(room, {&mounted, 1}, to, gridIn(number, to), seen);
        rooms_[to].model->keepFromBeyond(seen);
        for (const CellRun& run : seen.runs)
            for (const Copy& copy : copiesIn(number, to))
                for (std::size_t cell = run.first; cell < run.end; ++cell)
                    cells.set(copy.first + cell);
    }
}

/// Joins the candidates of one kind in several rooms, with the cells that they see in others.
class CoverageModel::Joiner {
  public:
    Joiner(CoverageModel& model, const SensorClass& kind, Progress& progress)
        : model_(model), kind_(kind), progress_(progress) {
        const SensorModel& whole = kind.whole ? *kind.whole : kind.model;
        const auto* camera = std::get_if<Camera>(&whole);
        for (std::size_t room = 0; camera != nullptr && room < model.rooms_.size(); ++room) {
            if (model.rooms_[room].model == nullptr) continue;
            const RoomModel& own = *model.rooms_[room].model;
            for (const UnseenFloor& floor : own.options().unseen)
                unseen_.push_back(
                    {room, withDensity(*camera, floor.density), unseenCells(floor, own.target())});
        }
    }

    /// Adds the candidates of a room.
    void add(std::size_t room, const PosedCandidates& own, PosedCandidates& joined) {
        joined.beginRoom(room);
        // Unseen floor counts even if views of other rooms do not.
        const bool looks =
            model_.joinsRooms() ||
            (!unseen_.empty() && model_.site_.sight != nullptr && model_.site_.sight->joinsRooms());
        constexpr std::size_t kAtOnce = 256;
        if (looks)
            progress_.begin("looking into other rooms", static_cast<std::int64_t>(own.sites()));
        for (std::size_t first = 0; first < own.sites(); first += kAtOnce) {
            const std::size_t end = std::min(first + kAtOnce, own.sites());
            beyond_.assign(end - first, {});
            is_seeing_.assign(end - first, {});
            if (looks && progress_.stopped()) {
                model_.is_complete_ = false;
            } else if (looks) {
                tbb::parallel_for(first, end, [&](std::size_t site) {
                    // A thread that waits for rows of cells here must not begin with another site.
                    tbb::this_task_arena::isolate([&] {
                        if (model_.joinsRooms()) beyond_[site - first] = look(room, own, site);
                        is_seeing_[site - first] = seesUnseen(room, own, site);
                    });
                });
                progress_.advance(static_cast<std::int64_t>(end - first));
            }
            for (std::size_t site = first; site < end; ++site)
                addSite(room, own, site, beyond_[site - first], is_seeing_[site - first], joined);
            if (joined.bytes() > model_.options_.max_bytes)
                throw UsageError(
                    "the candidates of rooms that are searched together take more "
                    "than " +
                    formatBytes(model_.options_.max_bytes) +
                    ": use fewer places, headings or cells, or --max-memory");
        }
        if (looks) progress_.end();
    }

  private:
    /// Floor of a room that cameras must not see with so many pixels.
    struct UnseenCells {
        std::size_t room = 0;
        Camera camera;
        CellSet cells;
    };

    /// Returns the candidates of a site from which a camera sees unseen floor of other rooms;
    /// empty if there are none.
    [[nodiscard]] std::vector<bool> seesUnseen(std::size_t from, const PosedCandidates& own,
                                               std::size_t site) const {
        std::vector<bool> is_seeing;
        for (const auto& [to, camera, cells] : unseen_) {
            std::vector<Sensor> turned;
            for (std::size_t i = own.firstOf(site); i < own.firstOf(site + 1); ++i)
                turned.push_back({"", camera, own.pose(i)});
            if (!model_.sees(*model_.site_.sight, from, turned.front(), to)) continue;
            is_seeing.resize(turned.size());
            CellParts seen;
            model_.site_.sight->look(from, turned, to, model_.rooms_[to].model->target().grid,
                                     seen);
            for (std::size_t k = 0; k < turned.size(); ++k)
                for (std::uint32_t r = seen.first[k]; r < seen.first[k + 1]; ++r)
                    for (std::size_t cell = seen.runs[r].first; cell < seen.runs[r].end; ++cell)
                        if (cells.test(cell)) is_seeing[k] = true;
        }
        return is_seeing;
    }

    [[nodiscard]] std::vector<CellsBeyond> look(std::size_t from, const PosedCandidates& own,
                                                std::size_t site) const {
        std::vector<Sensor> turned;
        for (std::size_t i = own.firstOf(site); i < own.firstOf(site + 1); ++i)
            turned.push_back({"", kind_.model, own.pose(i)});
        std::vector<CellsBeyond> all;
        for (std::size_t number = 0; number < model_.viewCases(); ++number) {
            const RoomSight& sight = model_.sightIn(number);
            std::vector<Sensor> mounted;
            mounted.reserve(turned.size());
            for (const Sensor& sensor : turned)
                mounted.push_back(model_.mountedIn(number, from, sensor));
            for (std::size_t to = 0; to < model_.rooms_.size(); ++to) {
                if (!model_.sees(sight, from, mounted.front(), to)) continue;
                CellsBeyond seen{to, number, {}};
                sight.look(from, mounted, to, model_.gridIn(number, to), seen.parts);
                model_.rooms_[to].model->keepFromBeyond(seen.parts);
                if (!seen.parts.runs.empty()) all.push_back(std::move(seen));
            }
        }
        return all;
    }

    /// Adds cells of the room of the candidate.
    void addOwn(std::span<const CellRun> runs, std::size_t room) {
        for (const Copy& copy : model_.rooms_[room].copies)
            for (const CellRun& run : runs) {
                const std::size_t first = std::max<std::size_t>(run.first, copy.own.first);
                const std::size_t end = std::min<std::size_t>(run.end, copy.own.end);
                if (first < end) addRun(copy.first + first - copy.own.first, end - first);
            }
    }
    /// Adds cells of another room in a case.
    void addBeyond(std::span<const CellRun> runs, const CellsBeyond& of) {
        for (const Copy& copy : model_.copiesIn(of.in, of.room))
            for (const CellRun& run : runs) addRun(copy.first + run.first, run.end - run.first);
    }
    void addRun(std::size_t first, std::size_t count) {
        parts_.runs.push_back(
            {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(first + count)});
    }
    void endPart() { parts_.first.push_back(static_cast<std::uint32_t>(parts_.runs.size())); }

    void addSite(std::size_t room, const PosedCandidates& own, std::size_t site,
                 const std::vector<CellsBeyond>& beyond, const std::vector<bool>& is_seeing,
                 PosedCandidates& joined) {
        const std::size_t begin = own.firstOf(site), count = own.firstOf(site + 1) - begin;
        parts_.runs.clear();
        parts_.first.assign(1, 0);
        ranges_.clear();
        headings_.clear();
        const auto is_left_out = [&](std::size_t k) { return !is_seeing.empty() && is_seeing[k]; };
        for (std::size_t k = 0; k < count; ++k)
            if (!is_left_out(k)) headings_.push_back(own.pose(begin + k).heading);
        if (headings_.empty()) return;
        if (beyond.empty()) {
            for (std::size_t k = 0; k <= own.directedParts(site); ++k) {
                addOwn(own.runsOf(site, k), room);
                endPart();
            }
            for (std::size_t k = 0; k < count; ++k)
                if (!is_left_out(k)) ranges_.push_back(own.rangeOf(begin + k));
        } else {
            for (std::size_t k = 0; k < count; ++k) {
                if (is_left_out(k)) continue;
                addOwn(partOf(own.cellsOf(begin + k)).runs, room);
                for (const CellsBeyond& seen : beyond) {
                    const std::vector<std::uint32_t>& first = seen.parts.first;
                    addBeyond(std::span(seen.parts.runs).subspan(first[k], first[k + 1] - first[k]),
                              seen);
                }
                ranges_.push_back({static_cast<std::uint32_t>(parts_.size()), 1});
                endPart();
            }
            endPart();
        }
        joined.addSite(own.pose(begin), headings_, ranges_, parts_);
        for (const CellsBeyond& seen : beyond) model_.rooms_[room].seen[seen.room] = true;
    }

    CoverageModel& model_;
    const SensorClass& kind_;
    Progress& progress_;
    std::vector<UnseenCells> unseen_;
    // Of the current sites:
    std::vector<std::vector<CellsBeyond>> beyond_;
    std::vector<std::vector<bool>> is_seeing_;
    CellParts parts_;
    std::vector<CandidateSet::PartRange> ranges_;
    std::vector<Angle> headings_;
};

std::unique_ptr<PosedCandidates> CoverageModel::candidatesOf(const SensorClass& kind,
                                                             Progress& progress) {
    const auto no_place = [&](bool is_complete, const std::vector<UnseenFloor>& unseen) {
        return is_complete && !unseen.empty()
                   ? "no place for " + nameOf(kind) + ": all see zones of " +
                         std::string(unseen.front().option)
                   : "stopped before there was any candidate for " + nameOf(kind);
    };
    if (hasCellsOfRoom()) {
        CandidatePool::Made made = only().pool().make(kind);
        is_complete_ = is_complete_ && made.is_complete;
        if (made.set->size() == 0) throw UnmetError(no_place(made.is_complete, options_.unseen));
        return std::move(made.set);
    }
    auto joined = std::make_unique<PosedCandidates>(problem_.cells());
    Joiner joiner(*this, kind, progress);
    std::map<const RoomModel*, std::unique_ptr<PosedCandidates>> known;
    std::string reason;
    for (std::size_t room = 0; room < rooms_.size(); ++room) {
        if (!mayStand(kind, room)) continue;
        RoomModel& model = *rooms_[room].model;
        std::unique_ptr<PosedCandidates>& set = known[&model];
        if (set == nullptr) {
            try {
                CandidatePool::Made made = model.pool().make(kind);
                is_complete_ = is_complete_ && made.is_complete;
                set = std::move(made.set);
                if (set->size() == 0 && reason.empty())
                    reason = no_place(made.is_complete, model.options().unseen);
            } catch (const UnmetError& error) {  // another room may have a place
                set = std::make_unique<PosedCandidates>(model.weights().size());
                if (reason.empty()) reason = site_.rooms[room].id + ": " + error.what();
            }
        }
        if (set->size() > 0) joiner.add(room, *set, *joined);
        // Later rooms may be equal.
        if (rooms_[room].model.use_count() == 1) set.reset();
    }
    if (joined->size() == 0)
        throw UnmetError(reason.empty() ? "no place for " + nameOf(kind) +
                                              (kind.room ? ": all floor of its room is open"
                                                         : ": no room may hold it")
                                        : reason);
    return joined;
}

/// Makes the candidates of each kind, and the order in which sensors are placed unless their number
/// is searched.
void CoverageModel::addKinds(Progress& progress) {
    for (const SensorClass& kind : kinds_) {
        sets_.push_back(candidatesOf(kind, progress));
        problem_.kinds.push_back(
            {sets_.back().get(), kind.most, kind.cost, isPartial(kind.model) ? 1 : unit_});
    }
    cases_.problem = &problem_;
    if (options_.budget || options_.target) return;
    for (const Placement& sensor : sensorsToPlace(groups_, kinds_))
        problem_.order.push_back(sensor.kind);
}

CellBlock CoverageModel::cellsOfRoom(std::size_t room) const {
    const std::size_t first = rooms_[room].copies.front().first;
    return {first, first + rooms_[room].cells};
}

std::vector<CoverageModel::Part> CoverageModel::parts() const {
    std::vector<std::size_t> of(rooms_.size());
    std::iota(of.begin(), of.end(), std::size_t{0});
    for (std::size_t from = 0; from < of.size(); ++from)
        for (std::size_t to = 0; to < of.size(); ++to) {
            const std::size_t low = std::min(of[from], of[to]), high = std::max(of[from], of[to]);
            if (rooms_[from].seen[to] && low != high) std::replace(of.begin(), of.end(), high, low);
        }
    std::map<std::size_t, Part> by_first;
    for (std::size_t i = 0; i < of.size(); ++i)
        if (rooms_[i].model != nullptr) by_first[of[i]].rooms.push_back(i);
    std::vector<Part> parts;
    const auto standing = [this](std::size_t room) {
        const CellBlock block = cellsOfRoom(room);
        return std::span(problem_.achieved).subspan(block.first, block.end - block.first);
    };
    for (auto& [first, part] : by_first) {
        part.alike = parts.size();
        for (std::size_t k = 0; k < parts.size() && part.rooms.size() == 1; ++k) {
            const std::size_t room = part.rooms.front(), other = parts[k].rooms.front();
            const auto here = standing(room), there = standing(other);
            if (parts[k].rooms.size() != 1 || rooms_[room].model != rooms_[other].model ||
                !std::equal(here.begin(), here.end(), there.begin(), there.end()))
                continue;
            part.alike = parts[k].alike;
            break;
        }
        parts.push_back(std::move(part));
    }
    return parts;
}

/// Names the part of each cell: coverage is to be connected within each.
void CoverageModel::addRegions() {
    const std::vector<Part> all = parts();
    if (all.size() < 2) return;
    problem_.regions.resize(problem_.cells());
    for (std::size_t part = 0; part < all.size(); ++part)
        for (const std::size_t room : all[part].rooms) {
            const CellBlock block = cellsOfRoom(room);
            std::fill(problem_.regions.begin() + static_cast<std::ptrdiff_t>(block.first),
                      problem_.regions.begin() + static_cast<std::ptrdiff_t>(block.end),
                      static_cast<std::uint32_t>(part));
        }
}

std::size_t CoverageModel::candidates() const {
    std::size_t count = 0;
    for (const auto& set : sets_) count += set->size();
    return count;
}

std::size_t CoverageModel::bytes() const {
    std::size_t bytes = 0;
    for (const auto& set : sets_) bytes += set->bytes();
    return bytes;
}

SearchOptions CoverageModel::searchOptions() const {
    SearchOptions searching = options_.search;
    const std::size_t taken = std::min(bytes(), options_.max_bytes);
    searching.max_bytes = std::min(searching.max_bytes, options_.max_bytes - taken);
    return searching;
}

double CoverageModel::share(std::uint64_t value) const {
    return (1 - rounding_) * (static_cast<double>(value) / static_cast<double>(total_));
}

double CoverageModel::shareOf(std::span<const CountedView> views) const {
    if (areas_.empty()) return share(valueOf(views));
    std::vector<int> met(problem_.achieved.begin(), problem_.achieved.end());
    for (const CountedView& view : views)
        view.cells.forEach([&](std::size_t cell) { met[cell] += view.multiplicity; });
    double covered = 0;
    for (std::size_t i = 0; i < areas_.size(); ++i)
        if (met[i] >= problem_.required) covered += areas_[i];
    return covered;
}

double CoverageModel::shareOf(const std::vector<Choice>& chosen, std::uint64_t value) const {
    if (areas_.empty() || options_.cases || options_.objective) return share(value);
    std::vector<CountedView> views;
    for (const Choice& choice : chosen) {
        const SensorType& kind = problem_.kinds[choice.kind];
        views.push_back({kind.candidates->cellsOf(choice.candidate), kind.multiplicity});
    }
    return shareOf(std::span<const CountedView>(views));
}

std::uint64_t CoverageModel::valueFor(double share) const {
    const auto total = static_cast<double>(total_);
    return static_cast<std::uint64_t>(
        std::ceil(std::max(0.0, share * total - 1e-6 - rounding_ * total)));
}

std::vector<std::uint32_t> CoverageModel::weightsLeft() const {
    std::vector<std::uint32_t> left = problem_.weights;
    for (std::size_t i = 0; i < left.size(); ++i)
        if (problem_.achieved[i] >= problem_.required) left[i] = 0;
    return left;
}

Point3 CoverageModel::positionOf(const Choice& choice) const {
    return site_.rooms[roomOf(choice)].inSite(poseOf(choice).position);
}

std::vector<Placement> CoverageModel::placementsOf(const std::vector<Choice>& chosen) const {
    std::vector<std::vector<RoomPose>> poses(kinds_.size());
    for (const Choice& choice : chosen)
        poses[choice.kind].push_back({roomOf(choice), poseOf(choice)});
    std::vector<const Scene*> scenes;
    for (const SiteRoom& room : site_.rooms) scenes.push_back(room.scene.get());
    return ispace::placementsOf(scenes, groups_, kinds_, poses);
}

std::vector<CountedView> CoverageModel::viewsOf(std::span<const SiteSensor> sensors) const {
    std::vector<CountedView> views(sensors.size());
    for (const auto& [room, sensor] : sensors)
        if (rooms_[room].model != nullptr) rooms_[room].model->prepare(sensor);
    tbb::parallel_for(std::size_t{0}, sensors.size(), [&](std::size_t i) {
        // A thread that waits for a level in here must not begin with another sensor.
        tbb::this_task_arena::isolate([&] {
            const auto& [room, sensor] = sensors[i];
            const Room& own = rooms_[room];
            views[i].multiplicity = isPartial(sensor.model) ? 1 : unit_;
            if (own.model != nullptr) views[i].cells = own.model->cellsOf(sensor, problem_.cells());
            if (hasCellsOfRoom()) return;
            CellSet cells(problem_.cells());
            views[i].cells.forEach([&](std::size_t cell) {
                for (const Copy& copy : own.copies)
                    if (cell >= copy.own.first && cell < copy.own.end)
                        cells.set(copy.first + cell - copy.own.first);
            });
            for (std::size_t number = 0; joinsRooms() && number < viewCases(); ++number)
                addBeyond(number, room, sensor, cells);
            views[i].cells = std::move(cells);
        });
    });
    return views;
}

std::vector<CountedView> CoverageModel::viewsOf(std::span<const Placement> placements) const {
    std::vector<SiteSensor> sensors;
    for (const Placement& placement : placements)
        sensors.push_back({placement.room, sensorOf(groups_, placement)});
    return viewsOf(std::span<const SiteSensor>(sensors));
}

CellSet CoverageModel::servedBy(std::span<const CountedView> views) const {
    std::vector<int> met(problem_.achieved.begin(), problem_.achieved.end());
    for (const CountedView& view : views)
        view.cells.forEach([&](std::size_t cell) { met[cell] += view.multiplicity; });
    CellSet served(met.size());
    for (std::size_t i = 0; i < met.size(); ++i)
        if (met[i] >= problem_.required && problem_.weights[i] > 0) served.set(i);
    return served;
}

std::uint64_t CoverageModel::valueOf(std::span<const CountedView> views) const {
    std::uint64_t value = 0;
    servedBy(views).forEach([&](std::size_t cell) { value += problem_.weights[cell]; });
    return value;
}

bool CoverageModel::isConnected(std::span<const CountedView> views) const {
    std::vector<const CellSet*> cells;
    cells.reserve(views.size());
    for (const CountedView& view : views) cells.push_back(&view.cells);
    return Connection(problem_, cells).isWhole();
}

void CoverageModel::spreadRedundant(std::vector<Choice>& chosen) const {
    std::vector<Point3> standing;
    for (const SiteRoom& room : site_.rooms) {
        for (const Sensor& sensor : room.scene->sensors)
            if (kindOf(sensor.model).perceives)
                standing.push_back(room.inSite(sensor.pose.position));
    }
    const auto position_of = [this](const Choice& choice) { return positionOf(choice); };
    ispace::spreadRedundant(problem_, standing, position_of, chosen);
}

std::uint64_t CoverageModel::maxFromAnyPlace(const std::vector<int>& most) const {
    std::vector<std::uint64_t> in_view;
    for (const SensorClass& kind : kinds_) {
        std::uint64_t& cells = in_view.emplace_back(0);
        for (const Room& room : rooms_) {
            if (room.model == nullptr) continue;
            const std::uint64_t own = maxCellsInView(kind.model, room.model->target().grid);
            cells = joinsRooms() ? cells + own : std::max(cells, own);
        }
    }
    return ispace::maxFromAnyPlace(problem_, in_view, most);
}

namespace {

void addSliceAreas(RayScenes& worlds, const Laser& laser, std::span<TriedPose> poses) {
    for (const TriedPose& tried : poses) worlds.prepare(tried.pose);
    tbb::parallel_for(std::size_t{0}, poses.size(), [&](std::size_t i) {
        const Sensor placed{"", laser, poses[i].pose};
        poses[i].slice_area = sliceArea(laser, castBeams(worlds.at(placed.pose), placed));
    });
}

}  // namespace

TriedPose CoverageModel::tried(const std::string& sensor, const Choice& choice,
                               double value) const {
    return {sensor, poseOf(choice), value, false, {}, site_.rooms[roomOf(choice)].id};
}

std::vector<TriedPose> CoverageModel::triedPoses(const std::vector<Choice>& chosen) {
    const WeightSums weights(weightsLeft());
    std::vector<TriedPose> all;
    all.reserve(candidates());
    for (std::size_t k = 0; k < problem_.kinds.size(); ++k) {
        const CandidateSet& set = *problem_.kinds[k].candidates;
        const SensorClass& kind = kinds_[k];
        std::vector<std::uint32_t> values(set.size());
        set.weighAll(weights, values);
        const double part = static_cast<double>(problem_.kinds[k].multiplicity) / problem_.required;
        const std::size_t first = all.size();
        for (std::size_t i = 0; i < set.size(); ++i)
            all.push_back(tried(kind.id, {k, i}, part * share(values[i])));
        for (const Choice& choice : chosen)
            if (choice.kind == k) all[first + choice.candidate].is_chosen = true;
        const auto* laser = std::get_if<Laser>(&kind.model);
        if (laser == nullptr) continue;
        // The candidates of a room follow each other.
        for (std::size_t i = 0; i < set.size();) {
            const std::size_t room = roomOf({k, i}), begin = i;
            while (i < set.size() && roomOf({k, i}) == room) ++i;
            addSliceAreas(rooms_[room].model->worlds(),
                          options_.beam_step ? withBeamStep(*laser, *options_.beam_step) : *laser,
                          std::span(all).subspan(first + begin, i - begin));
        }
    }
    return all;
}

std::vector<GainMap> CoverageModel::gainMaps(std::vector<Choice> chosen) const {
    std::vector<Placement> placements = placementsOf(chosen);
    std::vector<std::uint32_t> times(problem_.cells());
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = problem_.achieved[i];
    std::vector<GainMap> maps;
    std::vector<Placement> before;
    while (!chosen.empty()) {
        std::vector<std::uint32_t> left = problem_.weights;
        for (std::size_t i = 0; i < left.size(); ++i)
            if (times[i] >= static_cast<std::uint32_t>(problem_.required)) left[i] = 0;
        const WeightSums weights(left);
        const auto gain_of = [&](const Choice& choice) {
            return problem_.kinds[choice.kind].candidates->weigh(choice.candidate, weights);
        };
        const auto next = std::max_element(
            chosen.begin(), chosen.end(),
            [&](const Choice& a, const Choice& b) { return gain_of(a) < gain_of(b); });
        const auto [kind, candidate] = *next;
        const Pose3 pose = poseOf(*next);
        const auto placed = std::find_if(
            placements.begin(), placements.end(), [&, kind = kind](const Placement& placement) {
                return placement.kind == kind && placement.pose == pose &&
                       placement.room == roomOf(*next);
            });
        GainMap& map = maps.emplace_back(GainMap{wholeId(site_, *placed), before});
        const CandidateSet& set = *problem_.kinds[kind].candidates;
        std::vector<std::uint32_t> values(set.size());
        set.weighAll(weights, values);
        const double part =
            static_cast<double>(problem_.kinds[kind].multiplicity) / problem_.required;
        for (std::size_t i = 0; i < set.size(); ++i) {
            map.poses.push_back(tried(map.sensor, {kind, i}, part * share(values[i])));
            map.poses.back().is_chosen = i == candidate;
        }
        const auto added = static_cast<std::uint32_t>(problem_.kinds[kind].multiplicity);
        set.cellsOf(candidate).forEach([&](std::size_t cell) { times[cell] += added; });
        before.push_back(*placed);
        placements.erase(placed);
        chosen.erase(next);
    }
    return maps;
}

}  // namespace ispace
