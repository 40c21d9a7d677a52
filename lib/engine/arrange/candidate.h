// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates: sensors at poses, with the cells that they see. These are the columns of the coverage
// problem; to compute them takes most of the time of a search.
//
// A site is a point at one height, tilt and roll; its candidates differ in heading and share
// storage. A level laser sees its visibility polygon within a sector, so the circle about a site is
// cut at the limits of all sectors, each part is rasterised once, and a candidate is a range of
// parts: a cell is reached once for all headings. A sensor with a field of view has a part for each
// heading; sight of the plane is found once for all of them, and for several tilts if they share
// SiteSights.
//
// Of the cells that count, views hold those that VisibleArea has, unless lasers see by beams or
// sensors stand off their poses (PoseErrors): tables and shared sights save time alone. Sites are
// scanned by several threads and added in order.
//
//     PosedCandidates set(grid.size());
//     const CandidateViews views(sight, grid, device, mount);
//     addCandidates(set, views, sites, max_bytes, progress);
//     const Pose3 first = set.pose(0);             // of the first heading of the first site
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arrange/placement_rules.h"
#include "arrange/search/cover_sets.h"
#include "arrange/search/search_share.h"
#include "base/cell_set.h"
#include "base/error.h"
#include "coverage/visible_area.h"
#include "geom/pose.h"
#include "raster/grid.h"
#include "scene/sensor/sensor.h"
#include "trace/ray_world.h"

namespace ispace {

/// Candidates with their poses; the candidates of one site differ only in heading. Besides the
/// memory of CandidateSet it takes a heading for each candidate and a pose for each site. Const
/// members are thread-safe.
class PosedCandidates : public CandidateSet {
  public:
    using CandidateSet::CandidateSet;

    /// As CandidateSet::addSite(); candidate k has headings[k].
    /// \pre as many headings as ranges
    /// \param mount its heading is ignored
    void addSite(const Pose3& mount, std::span<const Angle> headings,
                 std::span<const PartRange> ranges, const CellParts& parts) {
        CandidateSet::addSite(ranges, parts);
        mounts_.push_back(mount);
        headings_.insert(headings_.end(), headings.begin(), headings.end());
    }
    /// Candidates that are added from here on stand in this room of the site; before, in room 0.
    void beginRoom(std::size_t room) { rooms_.push_back({size(), room}); }
    /// O(log rooms)
    [[nodiscard]] std::size_t roomOf(std::size_t candidate) const {
        const auto next = std::ranges::upper_bound(rooms_, candidate, {}, &RoomStart::candidate);
        return next == rooms_.begin() ? 0 : std::prev(next)->room;
    }
    [[nodiscard]] Pose3 pose(std::size_t candidate) const {
        Pose3 pose = mounts_[siteOf(candidate)];
        pose.heading = headings_[candidate];
        return pose;
    }
    /// Returns the memory in use, including the poses.
    [[nodiscard]] std::size_t bytes() const {
        return CandidateSet::bytes() + mounts_.size() * sizeof(Pose3) +
               headings_.size() * sizeof(Angle);
    }

  private:
    struct RoomStart {
        std::size_t candidate = 0, room = 0;
    };

    std::vector<RoomStart> rooms_;
    std::vector<Pose3> mounts_;    // by site
    std::vector<Angle> headings_;  // by candidate
};

class CoverRule;
class Demand;
class PoseErrors;
struct KnownSight;

/// The cells to which sensors at each of some sites, all at one height, have a free sight: views of
/// several tilts share them. Two bits a cell and site, filled as views ask. Thread-safe: a thread
/// that finds a site in use looks without it.
class SiteSights {
  public:
    /// \pre isWorthwhile()
    SiteSights(std::span<const Site> sites, const Grid& grid);
    ~SiteSights();
    SiteSights(const SiteSights&) = delete;
    SiteSights& operator=(const SiteSights&) = delete;
    /// Returns true if the sights of these sites fit in 100 MB.
    [[nodiscard]] static bool isWorthwhile(std::span<const Site> sites, const Grid& grid);

    /// The sight of a site while one thread looks from there.
    class Held {
      public:
        Held() = default;
        Held(std::unique_lock<std::mutex> lock, KnownSight* sight)
            : lock_(std::move(lock)), sight_(lock_.owns_lock() ? sight : nullptr) {}
        /// Returns null if the site is unknown, or another thread looks from there.
        [[nodiscard]] KnownSight* get() const { return sight_; }

      private:
        std::unique_lock<std::mutex> lock_;
        KnownSight* sight_ = nullptr;
    };
    [[nodiscard]] Held at(Point2 place);

  private:
    struct Of {
        std::mutex mutex;
        std::unique_ptr<KnownSight> sight;
    };
    std::size_t cells_;
    std::vector<std::pair<double, double>> places_;  // sorted, all different
    std::vector<Of> sights_;
};

/// Computes the cells of a grid that a kind of sensor sees from any site, mounted at one height
/// with one tilt and roll: the cells that VisibleArea::cellsOf() returns for a sensor there, unless
/// by beams. Thread-safe.
class CandidateViews {
  public:
    /// Views of slice lasers by single beams, see withBeamStep() and cellsByBeams().
    struct ByBeams {
        const RayScenes& worlds;  ///< the world of the mount is prepared
        Angle step;               ///< 0: the step of each laser
    };
    /// Stores references.
    /// \param mount only height, tilt and roll are used
    /// \param counted the cells with weight; null: all. Views contain arbitrary subsets of the
    ///        other cells, which saves memory
    /// \param by_beams empty: lasers in a slice see their whole visible area
    /// \param errors of sensors; null: they have the poses of their candidates
    /// \param rule of cells that some sensors alone cover; null: none
    CandidateViews(const VisibleArea& sight, const Grid& grid, const SensorModel& device,
                   const Pose3& mount, const CellSet* counted = nullptr,
                   const std::optional<ByBeams>& by_beams = {}, const PoseErrors* errors = nullptr,
                   const CoverRule* rule = nullptr);
    ~CandidateViews();
    CandidateViews(const CandidateViews&) = delete;
    CandidateViews& operator=(const CandidateViews&) = delete;

    /// Makes its cells the elements of a demand that a sensor serves, instead of those of the grid.
    /// Stores the references.
    /// \pre the demand accepts the device, `counted` is null, the world of the mount is prepared
    void serve(const Demand& demand, const RayScenes& worlds);

    /// Keeps the sight of each site for views of the same height and device. Stores the reference.
    void share(SiteSights& sights);

    /// Returns true if the view does not depend on the heading: a laser with a field of view of 360
    /// degrees, a cone that points straight down. A site then has one candidate, with its first
    /// heading.
    [[nodiscard]] bool isRound() const;

    struct Data;
    [[nodiscard]] const Data& data() const { return *data_; }

  private:
    std::unique_ptr<Data> data_;
};

/// Number of sites that yield candidates even if the search is stopped early, so that it has some
/// choice. Takes milliseconds; in rooms where a view takes longer, as many as StopGrace allows.
constexpr std::size_t kMinPlaces = 64;

/// Time that a stopped search still takes to make its first candidates, once for all kinds.
/// Thread-safe.
class StopGrace {
  public:
    /// Returns true once the grace since the first call is over.
    [[nodiscard]] bool isOver() {
        constexpr auto kGrace = std::chrono::milliseconds(400);
        using Clock = std::chrono::steady_clock;
        const auto now = Clock::now().time_since_epoch().count();
        auto begun = begun_.load();
        if (begun == 0 && begun_.compare_exchange_strong(begun, now)) begun = now;
        return Clock::duration(now - begun) > kGrace;
    }

  private:
    std::atomic<std::chrono::steady_clock::rep> begun_ = 0;
};

/// Appends the candidates of all sites, in order: each site becomes one site of the set, with a
/// candidate per heading (only the first if views.isRound()). Scans a few sites at a time in
/// parallel, so that memory stays close to that of the set; the result does not depend on the
/// number of threads. Returns false if progress said stop: the set then holds the sites scanned so
/// far and `least` of the others, or all, spread over the plan; in order.
/// \throws UsageError once set.bytes() exceeds max_bytes
///
/// With share.results, reads the views stored there and stores the others. A shard of the
/// candidates scans only its share of the sites: its candidates at all others have empty views.
bool addCandidates(PosedCandidates& set, const CandidateViews& views, std::span<const Site> sites,
                   std::size_t max_bytes, Progress& progress, std::size_t least = kMinPlaces,
                   const SearchShare& share = SearchShare(), StopGrace* grace = nullptr);

/// The views of one case, and where its cells begin in the set, see CaseRoom.
struct StackedViews {
    const CandidateViews* views = nullptr;
    std::size_t first = 0;
};
/// The same for several cases: a candidate sees its cells in all of them.
/// \pre the views are of one device, height, tilt and roll
bool addCandidates(PosedCandidates& set, std::span<const StackedViews> stack,
                   std::span<const Site> sites, std::size_t max_bytes, Progress& progress,
                   std::size_t least, const SearchShare& share, StopGrace* grace);

/// Returns the sites without the headings from which a sensor sees a counted cell, and without
/// sites that have no heading left. Keeps their order; several threads look.
std::vector<Site> sitesOutOfSight(const CandidateViews& views, std::span<const Site> sites);

}  // namespace ispace
