// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/candidate_views.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "base/packed.h"
#include "cover/plane_cells.h"
#include "cover/sector_cells.h"
#include "place/beam_cells.h"
#include "place/look_ahead.h"
#include "place/sensor_group.h"

namespace ispace {

namespace {

/// The sectors of a level laser at one place, by their limits.
struct Sectors {
    std::vector<Angle> headings;
    std::vector<Angle> limits;                    // none: it sees all around
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

/// Leaves out runs of cells that are not counted.
class Counted {
  public:
    explicit Counted(const CellSet& cells) : next_(cells.size() + 1), end_(cells.size() + 1) {
        const auto size = static_cast<std::uint32_t>(cells.size());
        next_[size] = size;
        for (std::uint32_t i = size; i-- > 0;) next_[i] = cells.test(i) ? i : next_[i + 1];
        end_[0] = 0;
        for (std::uint32_t i = 0; i < size; ++i) end_[i + 1] = cells.test(i) ? i + 1 : end_[i];
    }
    /// Afterwards all runs begin and end with counted cells.
    void keepIn(CellParts& parts) const {
        std::uint32_t count = 0, begin = 0;
        for (std::size_t part = 0; part < parts.size(); ++part) {
            const std::uint32_t end = parts.first[part + 1];
            for (std::uint32_t i = begin; i < end; ++i) {
                const CellRun run{next_[parts.runs[i].first], end_[parts.runs[i].end]};
                if (run.first < run.end) parts.runs[count++] = run;
            }
            begin = end;
            parts.first[part + 1] = count;
        }
        parts.runs.resize(count);
    }

  private:
    std::vector<std::uint32_t> next_;  // [i]: the first counted cell from i on
    std::vector<std::uint32_t> end_;   // [i]: the end of the last counted cell before i
};

}  // namespace

struct CandidateViews::Data {
    const Grid& grid;
    const Sight& sight;
    std::shared_ptr<const Level> level;
    SensorModel device;
    Pose3 mount;
    bool is_round, looks_in_slice;
    std::optional<Counted> counted = {};
    const RayWorld* beam_world = nullptr;  // of lasers that see by beams

    [[nodiscard]] std::size_t headingsOf(const Site& site) const {
        return is_round ? 1 : site.headings.size();
    }
    [[nodiscard]] Sensor at(const Site& site, std::size_t heading) const {
        Sensor sensor{"", device, mount};
        sensor.pose.position = {site.place.x, site.place.y, mount.position.z};
        sensor.pose.heading = site.headings[heading];
        return sensor;
    }
    /// The cells of each heading, a part each, and an empty one that all see.
    void lookAtPlane(const Site& site, CellParts& parts) const {
        const std::size_t headings = headingsOf(site);
        parts.runs.clear();
        parts.first.assign(headings + 2, 0);
        if (level->isBuried(site.place)) return;
        std::vector<FieldOfView> fields;
        for (std::size_t k = 0; k < headings; ++k)
            if (const auto field = fieldOfView(at(site, k))) fields.push_back(*field);
        if (!fields.empty()) {
            cellsByView(grid, sight.meshFor(device), fields, sight.plane(), parts);
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

CandidateViews::CandidateViews(const Sight& sight, const Grid& grid, const SensorModel& device,
                               const Pose3& mount, const CellSet* counted,
                               const std::optional<ByBeams>& by_beams)
    : data_(new Data{grid, sight, sight.levelAt(mount.position.z), device, mount,
                     looksAround(device, mount), scansSlice(Sensor{"", device, mount}),
                     counted != nullptr && counted->count() < counted->size()
                         ? std::optional<Counted>(*counted)
                         : std::nullopt}) {
    sight.prepare({"", device, mount});
    if (!by_beams || !data_->looks_in_slice) return;
    data_->looks_in_slice = false;
    data_->device = atResolution(std::get<Laser>(device), by_beams->step);
    data_->beam_world = &by_beams->worlds.at(mount);
}

CandidateViews::~CandidateViews() = default;

bool CandidateViews::isRound() const { return data_->is_round; }

namespace {

/// Looks from some sites at a time and adds what is seen to the set: first from a few all over the
/// list, whose cells wait on the shelf, then from all others in order. So whoever stops has
/// candidates everywhere, and nearly all go to the set at once.
class Scanner {
  public:
    Scanner(PosedCandidates& set, const CandidateViews& views, std::span<const Site> sites,
            std::size_t least, Progress& progress, const SearchShare& share)
        : set_(set),
          data_(views.data()),
          sites_(sites),
          progress_(progress),
          share_(share),
          least_(std::min(least, sites.size())),
          at_once_(data_.looks_in_slice ? 512 : 32),
          ahead_(sites, std::max(least_, sites.size() / kStretch)),
          shelf_(ahead_.size()) {}

    bool run(std::size_t max_bytes) {
        lookAhead(max_bytes / kShelfPart);
        return addAll(max_bytes);
    }

  private:
    /// One in so many is looked at ahead: enough to choose well from, and little to copy.
    static constexpr std::size_t kStretch = 32;
    /// On the shelf runs take twice the memory of the set.
    static constexpr std::size_t kShelfPart = kStretch / 2;
    static constexpr std::size_t kNone = ~std::size_t{0};

    /// A site to look at now.
    struct Turn {
        std::size_t site;
        std::size_t slot;  ///< on the shelf, or kNone
    };

    /// Puts what is seen from sites all over the list on the shelf, until progress says stop or the
    /// shelf is full; but from least_ sites always.
    void lookAhead(std::size_t max_shelved) {
        for (std::size_t k = 0; k < ahead_.size();) {
            const std::size_t must = least_ - std::min(k, least_);
            const bool is_stopped = progress_.stopped() || shelf_.bytes() > max_shelved;
            const std::size_t end =
                k + std::min({at_once_, ahead_.size() - k, is_stopped ? must : at_once_});
            if (k == end) return;
            turns_.clear();
            for (; k < end; ++k) turns_.push_back({ahead_.turn(k), ahead_.slotOf(ahead_.turn(k))});
            look(must);
            for (std::size_t i = 0; i < turns_.size(); ++i)
                if (is_done_[i] != 0) shelf_.put(turns_[i].slot, parts_[i]);
        }
    }

    /// Adds all sites; once progress says stop, only those of the rest that are on the shelf.
    /// True if that were all.
    bool addAll(std::size_t max_bytes) {
        std::size_t slot = 0, added = 0;
        for (std::size_t site = 0; site < sites_.size();) {
            const bool is_stopped = progress_.stopped();
            turns_.clear();
            for (; site < sites_.size() && turns_.size() < at_once_; ++site) {
                const bool is_ahead = slot < ahead_.size() && ahead_.at(slot) == site;
                const bool is_shelved = is_ahead && shelf_.has(slot);
                if (is_shelved || !is_stopped) turns_.push_back({site, is_shelved ? slot : kNone});
                if (is_ahead) ++slot;
            }
            look(0);
            for (std::size_t i = 0; i < turns_.size(); ++i) {
                if (is_done_[i] == 0) continue;
                add(i);
                ++added;
                if (set_.bytes() > max_bytes) throw UsageError(tooLarge(max_bytes));
            }
            shelf_.dropBefore(slot);
        }
        return added == sites_.size();
    }

    static std::string tooLarge(std::size_t max_bytes) {
        return "the candidates take more than " + formatBytes(max_bytes) +
               ": use fewer places, headings or cells, or --max-memory";
    }

    /// Fills parts_ and, for slices, sectors_ of the sites at hand, from the shelf where they are
    /// on it. What is seen of a plane takes a while: one can stop in between, but for the first
    /// `must` of them.
    void look(std::size_t must) {
        const std::size_t count = turns_.size();
        if (parts_.size() < count) parts_.resize(count);
        is_done_.assign(count, 1);
        if (data_.looks_in_slice) findSectors(count);
        const int step = share_.ledger != nullptr ? share_.ledger->numberOf("views/") : 0;
        const std::string name = "views/" + std::to_string(step);
        if (recall(name) || leaveToOthers(step)) return;
        std::atomic<std::int64_t> looks = 0;
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
            if (isShelved(i)) {
                shelf_.copy(turns_[i].slot, parts_[i]);
            } else if (data_.looks_in_slice) {
                lookFrom(i);
                ++looks;
            } else if (i >= must && progress_.stopped()) {
                is_done_[i] = 0;
            } else {
                // Whoever waits for rows of cells here does not begin with another site.
                tbb::this_task_arena::isolate([&] { lookFrom(i); });
                ++looks;
            }
        });
        progress_.advance(looks);
        if (share_.ledger != nullptr && looks > 0 && !progress_.stopped()) keep(name);
    }

    /// Takes what an earlier run or another shard saw in this step.
    bool recall(const std::string& name) {
        const auto bytes = share_.ledger != nullptr ? share_.ledger->find(name) : std::nullopt;
        if (!bytes) return false;
        Unpacker from(*bytes);
        for (std::size_t i = 0; i < turns_.size(); ++i) {
            if (isShelved(i)) {
                shelf_.copy(turns_[i].slot, parts_[i]);
                continue;
            }
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
            if (isShelved(i)) continue;
            to.addAll(parts_[i].runs);
            to.addAll(parts_[i].first);
        }
        share_.ledger->keep(name, to.bytes());
    }
    /// A step of another shard: nothing is seen.
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
    /// Directed parts of what is seen from a site.
    [[nodiscard]] std::size_t directedOf(std::size_t i) const {
        return data_.looks_in_slice ? sectors_[sectors_of_[i]].limits.size() : headingsOf(i).size();
    }

    [[nodiscard]] bool isShelved(std::size_t i) const {
        return turns_[i].slot != kNone && shelf_.has(turns_[i].slot);
    }

    /// Neighbours mostly have the same headings.
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
        const Site& site = sites_[turns_[i].site];
        return std::span(site.headings).first(data_.headingsOf(site));
    }

    void lookFrom(std::size_t i) {
        const Site& site = sites_[turns_[i].site];
        assert(!site.headings.empty());
        if (data_.looks_in_slice)
            cellsBySector(data_.grid, *data_.level, site.place,
                          std::get<Laser>(data_.device).max_range, sectors_[sectors_of_[i]].limits,
                          parts_[i]);
        else
            data_.lookAtPlane(site, parts_[i]);
        if (data_.counted) data_.counted->keepIn(parts_[i]);
    }

    void add(std::size_t i) {
        const Site& site = sites_[turns_[i].site];
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
    const CandidateViews::Data& data_;
    std::span<const Site> sites_;
    Progress& progress_;
    const SearchShare& share_;
    std::size_t least_, at_once_;
    Spread ahead_;
    Shelf shelf_;  // in the order of ahead_.at()
    // Of the sites at hand:
    std::vector<Turn> turns_;
    std::vector<char> is_done_;
    std::vector<CellParts> parts_;
    std::vector<Sectors> sectors_;
    std::vector<std::size_t> sectors_of_;
    std::vector<CandidateSet::PartRange> ranges_;
};

}  // namespace

bool addCandidates(PosedCandidates& set, const CandidateViews& views, std::span<const Site> sites,
                   std::size_t max_bytes, Progress& progress, std::size_t least,
                   const SearchShare& share) {
    assert(set.cells() == views.data().grid.size());
    progress.begin("scanning candidates", static_cast<std::int64_t>(sites.size()));
    const bool is_complete = Scanner(set, views, sites, least, progress, share).run(max_bytes);
    progress.end();
    return is_complete;
}

}  // namespace ispace
