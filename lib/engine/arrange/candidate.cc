// SPDX-License-Identifier: GPL-3.0-or-later
// Computes the views of candidates, site by site.
//
// Sites are taken in batches of 512 for lasers in a slice, of 32 for views of a plane, which take
// longer: several threads look, and the batch is added in order, so the set is the same for any
// number of threads and holds little besides itself. A batch is also the step that shards divide
// and that --resume stores. Once progress says stop, a sample of the remaining sites, spread along
// a Morton curve, follows, so that a stopped search has candidates everywhere.
#include "arrange/candidate.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrange/beam_cells.h"
#include "arrange/demand.h"
#include "arrange/layout_cases.h"
#include "arrange/sensor_group.h"
#include "arrange/view_rules.h"
#include "base/error.h"
#include "base/number.h"
#include "base/packed.h"
#include "coverage/counted_cells.h"
#include "coverage/plane_cells.h"
#include "coverage/sector_cells.h"

namespace ispace {

namespace {

/// The sectors of a level laser at one site, by their limits.
struct Sectors {
    std::vector<Angle> headings;
    std::vector<Angle> limits;                    // empty: it sees all around
    std::vector<CandidateSet::PartRange> ranges;  // by heading

    Sectors(const Laser& laser, std::span<const Angle> of) : headings(of.begin(), of.end()) {
        ranges.resize(headings.size());
        std::vector<Sector> sectors;
        sectors.reserve(headings.size());
        for (const Angle heading : headings)
            if (const auto sector = sectorOf(laser, heading)) sectors.push_back(*sector);
        for (const Sector& sector : sectors)
            limits.insert(limits.end(), {sector.first, sector.beyond});
        std::sort(limits.begin(), limits.end());
        limits.erase(std::unique(limits.begin(), limits.end()), limits.end());
        const auto directed = static_cast<std::uint32_t>(limits.size());
        for (std::size_t k = 0; k < sectors.size(); ++k) {
            const std::uint32_t begin = indexOf(sectors[k].first);
            ranges[k] = {begin, (indexOf(sectors[k].beyond) + directed - begin) % directed};
        }
    }

  private:
    [[nodiscard]] std::uint32_t indexOf(Angle limit) const {
        return static_cast<std::uint32_t>(std::lower_bound(limits.begin(), limits.end(), limit) -
                                          limits.begin());
    }
};

/// Copies the parts between sorted limits so that part i begins at limits[i]; the last part stays.
/// Limits that rounding made equal have an empty part between them.
void inOrderOf(std::span<const Angle> limits, std::span<const Angle> sorted, const CellParts& seen,
               CellParts& parts) {
    parts.runs.clear();
    parts.first.assign(1, 0);
    const auto add = [&](std::size_t part) {
        for (std::uint32_t r = seen.first[part]; r < seen.first[part + 1]; ++r)
            parts.runs.push_back(seen.runs[r]);
    };
    const auto index_of = [&](Angle limit) {
        return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), limit) -
                                        sorted.begin());
    };
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const std::size_t begin = index_of(limits[i]);
        const bool is_empty = limits.size() > 1 && limits[i] == limits[(i + 1) % limits.size()];
        if (!is_empty) add(begin);
        parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
    }
    add(sorted.size());
    parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
}

}  // namespace

SiteSights::SiteSights(std::span<const Site> sites, const Grid& grid) : cells_(grid.size()) {
    places_.reserve(sites.size());
    for (const Site& site : sites) places_.emplace_back(site.place.x, site.place.y);
    std::sort(places_.begin(), places_.end());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
    sights_ = std::vector<Of>(places_.size());
}

SiteSights::~SiteSights() = default;

bool SiteSights::isWorthwhile(std::span<const Site> sites, const Grid& grid) {
    constexpr std::size_t kMaxBytes = 100'000'000, kCellsPerByte = 4;
    return sites.size() <= kMaxBytes / (1 + grid.size() / kCellsPerByte);
}

SiteSights::Held SiteSights::at(Point2 place) {
    const auto found =
        std::lower_bound(places_.begin(), places_.end(), std::pair(place.x, place.y));
    if (found == places_.end() || *found != std::pair(place.x, place.y)) return {};
    Of& of = sights_[static_cast<std::size_t>(found - places_.begin())];
    std::unique_lock lock(of.mutex, std::try_to_lock);
    if (lock && of.sight == nullptr) of.sight = std::make_unique<KnownSight>(cells_);
    KnownSight* const sight = lock ? of.sight.get() : nullptr;
    return {std::move(lock), sight};
}

struct CandidateViews::Data {
    const Grid& grid;
    const VisibleArea& sight;
    std::shared_ptr<const Level> level;
    SensorModel device;
    Pose3 mount;
    bool is_round, looks_in_slice;
    std::optional<CountedCells> counted = {};
    CellWindow window = {};                // of the counted cells
    const RayWorld* beam_world = nullptr;  // of lasers that see by beams; else null
    const PoseErrors* errors = nullptr;    // null: none
    const CoverRule* rule = nullptr;       // null: none
    const Demand* demand = nullptr;        // null: its cells are those of the grid
    const RayScenes* worlds = nullptr;     // of the demand
    SiteSights* sights = nullptr;          // null: of this tilt alone

    [[nodiscard]] std::size_t headingsOf(const Site& site) const {
        return is_round ? 1 : site.headings.size();
    }
    [[nodiscard]] Sensor at(const Site& site, std::size_t heading) const {
        Sensor sensor{"", device, mount};
        sensor.pose.position = {site.place.x, site.place.y, mount.position.z};
        sensor.pose.heading = site.headings[heading];
        if (errors != nullptr) sensor.pose = errors->actual(sensor);
        return sensor;
    }
    /// Computes the cells of a level laser between these limits, which turn with its errors.
    void lookBySector(const Site& site, std::span<const Angle> limits, CellParts& parts) const {
        const double range = std::get<Laser>(device).max_range;
        if (errors == nullptr) return cellsBySector(grid, *level, site.place, range, limits, parts);
        const Pose3 pose = at(site, 0).pose;
        const Angle turn = pose.heading - site.headings[0];
        std::vector<Angle> turned;
        for (const Angle limit : limits) turned.push_back(wrapped(limit + turn));
        std::vector<Angle> sorted = turned;
        std::sort(sorted.begin(), sorted.end());
        sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
        CellParts seen;
        cellsBySector(grid, *level, pose.position.onFloor(), range, sorted, seen);
        inOrderOf(turned, sorted, seen, parts);
    }
    /// Computes the elements that each heading serves, like lookAtPlane().
    void lookAtDemand(const Site& site, CellParts& parts) const {
        parts.first.resize(1);
        const std::vector<std::uint8_t> shared = demand->sightOf(at(site, 0), *worlds);
        for (std::size_t k = 0; k < headingsOf(site); ++k) {
            const CellParts seen = partOf(demand->servedBy(at(site, k), shared));
            parts.runs.insert(parts.runs.end(), seen.runs.begin(), seen.runs.end());
            parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
        }
        parts.first.push_back(parts.first.back());
    }
    /// Returns a table for the headings that most sites share, if it is worth building.
    [[nodiscard]] std::optional<TurnedViews> turnedFor(std::span<const Site> sites) const {
        constexpr std::ptrdiff_t kWorthwhile = 24;  // sites
        if (is_round || errors != nullptr || demand != nullptr || looks_in_slice || sites.empty())
            return std::nullopt;
        const std::vector<Angle>& headings = sites[sites.size() / 2].headings;
        if (std::count_if(sites.begin(), sites.end(), [&](const Site& site) {
                return site.headings == headings;
            }) < kWorthwhile)
            return std::nullopt;
        const auto ahead = fieldOfView(at({{}, {Angle()}}, 0));
        return ahead ? turnedViews(*ahead, headings, sight.plane(), grid) : std::nullopt;
    }
    /// Computes the cells of each heading, one part each, and an empty part shared by all.
    /// \param turned of turnedFor()
    void lookAtPlane(const Site& site, const std::optional<TurnedViews>& turned,
                     CellParts& parts) const {
        const std::size_t headings = headingsOf(site);
        parts.runs.clear();
        parts.first.assign(headings + 2, 0);
        if (level->isInsideSolid(site.place)) return;
        if (demand != nullptr) return lookAtDemand(site, parts);
        std::vector<FieldOfView> fields;
        for (std::size_t k = 0; k < headings; ++k)
            if (const auto field = fieldOfView(at(site, k))) fields.push_back(*field);
        if (!fields.empty()) {
            const bool is_known =
                turned && std::equal(site.headings.begin(), site.headings.end(),
                                     turned->headings().begin(), turned->headings().end());
            const SiteSights::Held known =
                sights != nullptr ? sights->at(site.place) : SiteSights::Held();
            cellsByView(grid, sight.meshFor(device), fields, sight.plane(), parts,
                        {.window = window,
                         .counted = counted ? &*counted : nullptr,
                         .turned = is_known ? &*turned : nullptr,
                         .known = known.get()});
        } else {  // lasers
            parts.first.resize(1);
            for (std::size_t k = 0; k < headings; ++k) {
                const Sensor laser = at(site, k);
                const CellParts seen =
                    partOf(beam_world == nullptr ? sight.cellsOf(grid, laser)
                                                 : cellsByBeams(grid, *beam_world, laser));
                parts.runs.insert(parts.runs.end(), seen.runs.begin(), seen.runs.end());
                parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
            }
        }
        parts.first.push_back(parts.first.back());
    }
};

CandidateViews::CandidateViews(const VisibleArea& sight, const Grid& grid,
                               const SensorModel& device, const Pose3& mount,
                               const CellSet* counted, const std::optional<ByBeams>& by_beams,
                               const PoseErrors* errors, const CoverRule* rule)
    : data_(new Data{grid, sight, sight.levelAt(mount.position.z), device, mount,
                     isOmnidirectional(device, mount), scansSlice(Sensor{"", device, mount}),
                     counted != nullptr && counted->count() < counted->size()
                         ? std::optional<CountedCells>(*counted)
                         : std::nullopt}) {
    if (data_->counted) data_->window = CellWindow::of(grid, *counted);
    data_->errors = errors;
    data_->rule = rule;
    sight.prepare({"", device, mount});
    if (!by_beams || !data_->looks_in_slice) return;
    data_->looks_in_slice = false;
    data_->device = withBeamStep(std::get<Laser>(device), by_beams->step);
    data_->beam_world = &by_beams->worlds.at(mount);
}

CandidateViews::~CandidateViews() = default;

void CandidateViews::serve(const Demand& demand, const RayScenes& worlds) {
    data_->demand = &demand;
    data_->worlds = &worlds;
    data_->looks_in_slice = false;
}

void CandidateViews::share(SiteSights& sights) {
    if (data_->errors == nullptr) data_->sights = &sights;
}

bool CandidateViews::isRound() const { return data_->is_round; }

namespace {

/// Scans some sites at a time and adds their views to the set, in the order of the list. Once
/// progress says stop, scans only a sample of the other sites, so that candidates exist everywhere:
/// at least one, and more as long as the grace lasts.
class Scanner {
  public:
    Scanner(PosedCandidates& set, std::span<const StackedViews> stack, std::span<const Site> sites,
            std::size_t least, Progress& progress, const SearchShare& share, StopGrace* grace)
        : set_(set),
          stack_(stack),
          data_(stack.front().views->data()),
          sites_(sites),
          progress_(progress),
          share_(share),
          grace_(grace != nullptr ? *grace : own_grace_),
          least_(std::min(least, sites.size())),
          at_once_(data_.looks_in_slice ? 512 : 32) {
        for (const StackedViews& one : stack) turned_.push_back(one.views->data().turnedFor(sites));
    }

    /// Returns true if all sites were scanned.
    bool run(std::size_t max_bytes) {
        std::size_t next = 0;
        while (next < sites_.size() && !progress_.stopped()) {
            turns_.clear();
            for (; next < sites_.size() && turns_.size() < at_once_; ++next) turns_.push_back(next);
            const int step = share_.results != nullptr ? share_.results->numberOf("views/") : 0;
            const std::string name = "views/" + std::to_string(step);
            prepare();
            if (!recall(name) && !leaveToOthers(step)) {
                look(added_ >= least_, false);
                if (share_.results != nullptr && !progress_.stopped()) keep(name);
            }
            addSeen(max_bytes);
        }
        if (next < sites_.size()) {
            turns_ = sitesSpreadOver(sites_, next, std::min(least_, sites_.size() - next));
            prepare();
            look(false, set_.size() == 0);
            addSeen(max_bytes);
        }
        return added_ == sites_.size();
    }

  private:
    static std::string tooLarge(std::size_t max_bytes) {
        return "the candidates take more than " + formatBytes(max_bytes) +
               ": use fewer places, headings or cells, or --max-memory";
    }

    /// Allocates the views of the current batch of sites.
    void prepare() {
        if (parts_.size() < turns_.size()) parts_.resize(turns_.size());
        is_done_.assign(turns_.size(), 1);
        if (data_.looks_in_slice) findSectors(turns_.size());
    }

    /// Computes parts_ for the current batch. A view of a plane takes a while: may stop in between.
    /// \param has_enough does not need the grace \param needs_one looks at one in any case
    void look(bool has_enough, bool needs_one) {
        std::atomic<std::int64_t> looks = 0;
        tbb::parallel_for(std::size_t{0}, turns_.size(), [&](std::size_t i) {
            if (data_.looks_in_slice) {
                lookFrom(i);
            } else if (progress_.stopped() && (has_enough || grace_.isOver()) &&
                       !(needs_one && looks == 0)) {
                is_done_[i] = 0;
                return;
            } else {
                // A thread that waits for rows of cells here must not begin with another site.
                tbb::this_task_arena::isolate([&] { lookFrom(i); });
            }
            ++looks;
        });
        progress_.advance(looks);
    }

    void addSeen(std::size_t max_bytes) {
        for (std::size_t i = 0; i < turns_.size(); ++i) {
            if (is_done_[i] == 0) continue;
            add(i);
            ++added_;
            if (set_.bytes() > max_bytes) throw UsageError(tooLarge(max_bytes));
        }
    }

    /// Reads the views that an earlier run or another shard stored for this step.
    bool recall(const std::string& name) {
        const auto bytes = share_.results != nullptr ? share_.results->find(name) : std::nullopt;
        if (!bytes) return false;
        Unpacker from(*bytes);
        for (std::size_t i = 0; i < turns_.size(); ++i) {
            parts_[i].runs = from.all<CellRun>();
            parts_[i].first = from.all<std::uint32_t>();
            if (!isWhole(parts_[i], set_.cells()) || parts_[i].size() != directedOf(i) + 1)
                Unpacker::refuse();
            progress_.advance(1);
        }
        return true;
    }
    void keep(const std::string& name) {
        Packer to;
        for (std::size_t i = 0; i < turns_.size(); ++i) {
            to.addAll(parts_[i].runs);
            to.addAll(parts_[i].first);
        }
        share_.results->store(name, to.bytes());
    }
    /// Skips a step of another shard with empty views.
    bool leaveToOthers(int step) {
        if (!share_.isOwn(Shared::Candidates) ||
            (step - 1) % share_.own->count == share_.own->index - 1)
            return false;
        for (std::size_t i = 0; i < turns_.size(); ++i) {
            parts_[i].runs.clear();
            parts_[i].first.assign(directedOf(i) + 2, 0);
        }
        return true;
    }
    /// Returns the number of directed parts in a site's view.
    [[nodiscard]] std::size_t directedOf(std::size_t i) const {
        return data_.looks_in_slice ? sectors_[sectors_of_[i]].limits.size() : headingsOf(i).size();
    }

    /// Adjacent sites mostly have the same headings.
    void findSectors(std::size_t count) {
        if (sectors_.size() > 1) sectors_.erase(sectors_.begin(), sectors_.end() - 1);
        sectors_of_.clear();
        for (std::size_t i = 0; i < count; ++i) {
            const std::span<const Angle> headings = headingsOf(i);
            if (sectors_.empty() ||
                !std::equal(headings.begin(), headings.end(), sectors_.back().headings.begin(),
                            sectors_.back().headings.end()))
                sectors_.emplace_back(std::get<Laser>(data_.device), headings);
            sectors_of_.push_back(sectors_.size() - 1);
        }
    }

    [[nodiscard]] std::span<const Angle> headingsOf(std::size_t i) const {
        const Site& site = sites_[turns_[i]];
        return std::span(site.headings).first(data_.headingsOf(site));
    }

    void lookFrom(std::size_t i) {
        if (stack_.size() == 1 && stack_.front().first == 0) return lookIn(0, i, parts_[i]);
        std::vector<CellParts> views(stack_.size());
        for (std::size_t k = 0; k < stack_.size(); ++k) lookIn(k, i, views[k]);
        stack(views, parts_[i]);
    }

    void lookIn(std::size_t room, std::size_t i, CellParts& parts) const {
        const CandidateViews::Data& data = stack_[room].views->data();
        const Site& site = sites_[turns_[i]];
        assert(!site.headings.empty());
        if (data.looks_in_slice)
            data.lookBySector(site, sectors_[sectors_of_[i]].limits, parts);
        else
            data.lookAtPlane(site, turned_[room], parts);
        if (data.counted) data.counted->keepIn(parts);
        if (data.rule != nullptr) data.rule->keepCovered(data.device, site.place, parts);
    }

    /// Joins the views of all cases, part by part.
    void stack(std::span<const CellParts> views, CellParts& parts) const {
        parts.runs.clear();
        parts.first.assign(1, 0);
        for (std::size_t part = 0; part < views.front().size(); ++part) {
            for (std::size_t k = 0; k < views.size(); ++k) {
                const auto shift = static_cast<std::uint32_t>(stack_[k].first);
                for (std::uint32_t r = views[k].first[part]; r < views[k].first[part + 1]; ++r)
                    parts.runs.push_back(
                        {views[k].runs[r].first + shift, views[k].runs[r].end + shift});
            }
            parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
        }
    }

    void add(std::size_t i) {
        const Site& site = sites_[turns_[i]];
        Pose3 mount = data_.mount;
        mount.position = {site.place.x, site.place.y, mount.position.z};
        const std::span<const Angle> headings = headingsOf(i);
        if (data_.looks_in_slice) {
            set_.addSite(mount, headings, sectors_[sectors_of_[i]].ranges, parts_[i]);
            return;
        }
        ranges_.clear();
        for (std::uint32_t k = 0; k < headings.size(); ++k) ranges_.push_back({k, 1});
        set_.addSite(mount, headings, ranges_, parts_[i]);
    }

    PosedCandidates& set_;
    std::span<const StackedViews> stack_;
    const CandidateViews::Data& data_;  // of the first
    std::span<const Site> sites_;
    Progress& progress_;
    const SearchShare& share_;
    std::vector<std::optional<TurnedViews>> turned_;  // by case
    StopGrace own_grace_;
    StopGrace& grace_;
    std::size_t least_, at_once_;
    std::size_t added_ = 0;
    // Of the current batch:
    std::vector<std::size_t> turns_;
    std::vector<char> is_done_;
    std::vector<CellParts> parts_;
    std::vector<Sectors> sectors_;
    std::vector<std::size_t> sectors_of_;
    std::vector<CandidateSet::PartRange> ranges_;
};

}  // namespace

bool addCandidates(PosedCandidates& set, const CandidateViews& views, std::span<const Site> sites,
                   std::size_t max_bytes, Progress& progress, std::size_t least,
                   const SearchShare& share, StopGrace* grace) {
    assert(set.cells() == (views.data().demand != nullptr ? views.data().demand->weights().size()
                                                          : views.data().grid.size()));
    const StackedViews one{&views};
    return addCandidates(set, std::span(&one, 1), sites, max_bytes, progress, least, share, grace);
}

bool addCandidates(PosedCandidates& set, std::span<const StackedViews> stack,
                   std::span<const Site> sites, std::size_t max_bytes, Progress& progress,
                   std::size_t least, const SearchShare& share, StopGrace* grace) {
    progress.begin("scanning candidates", static_cast<std::int64_t>(sites.size()));
    const bool is_complete =
        Scanner(set, stack, sites, least, progress, share, grace).run(max_bytes);
    progress.end();
    return is_complete;
}

std::vector<Site> sitesOutOfSight(const CandidateViews& views, std::span<const Site> sites) {
    const CandidateViews::Data& data = views.data();
    const std::optional<TurnedViews> turned = data.turnedFor(sites);
    std::vector<Site> out(sites.begin(), sites.end());
    tbb::parallel_for(std::size_t{0}, out.size(), [&](std::size_t i) {
        tbb::this_task_arena::isolate([&] {
            CellParts parts;
            data.lookAtPlane(out[i], turned, parts);
            if (data.counted) data.counted->keepIn(parts);
            std::vector<Angle> headings;
            for (std::size_t k = 0; k < data.headingsOf(out[i]); ++k)
                if (parts.first[k] == parts.first[k + 1]) headings.push_back(out[i].headings[k]);
            out[i].headings = std::move(headings);
        });
    });
    std::erase_if(out, [](const Site& site) { return site.headings.empty(); });
    return out;
}

}  // namespace ispace
