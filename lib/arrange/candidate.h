// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
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

/// Candidates with their poses; those of one site differ only in heading.
class PosedCandidates : public CandidateSet {
  public:
    using CandidateSet::CandidateSet;

    /// As CandidateSet::addSite(); candidate k has headings[k]. \pre as many headings as ranges
    /// \param mount its heading is not used
    void addSite(const Pose3& mount, std::span<const Angle> headings,
                 std::span<const PartRange> ranges, const CellParts& parts) {
        CandidateSet::addSite(ranges, parts);
        mounts_.push_back(mount);
        headings_.insert(headings_.end(), headings.begin(), headings.end());
    }
    [[nodiscard]] Pose3 pose(std::size_t candidate) const {
        Pose3 pose = mounts_[siteOf(candidate)];
        pose.heading = headings_[candidate];
        return pose;
    }
    /// Memory, that of the poses included.
    [[nodiscard]] std::size_t bytes() const {
        return CandidateSet::bytes() + mounts_.size() * sizeof(Pose3) +
               headings_.size() * sizeof(Angle);
    }

  private:
    std::vector<Pose3> mounts_;    // by site
    std::vector<Angle> headings_;  // by candidate
};

/// What a kind of sensor sees of the cells of a grid from anywhere, mounted at one height with one
/// tilt and roll: the same cells as Sight::cellsOf() for a sensor there, unless by beams.
/// Thread-safe.
class CandidateViews {
  public:
    /// What lasers that scan a slice see by beams, see withBeamStep() and cellsByBeams().
    struct ByBeams {
        const Worlds& worlds;  ///< that of the mount is prepared
        Angle step;            ///< 0: their own
    };
    /// Keeps references.
    /// \param mount only height, tilt and roll are used
    /// \param counted the cells with weight; null: all. What candidates see of other cells is then
    ///        arbitrary, which saves memory
    /// \param by_beams none: lasers in a slice see all that is in their view
    CandidateViews(const VisibleArea& sight, const Grid& grid, const SensorModel& device,
                   const Pose3& mount, const CellSet* counted = nullptr,
                   const std::optional<ByBeams>& by_beams = {});
    ~CandidateViews();
    CandidateViews(const CandidateViews&) = delete;
    CandidateViews& operator=(const CandidateViews&) = delete;

    /// True if the view does not depend on the heading: a laser with a field of view of 360
    /// degrees, a cone that points straight down. A site then has one candidate, with its first
    /// heading.
    [[nodiscard]] bool isRound() const;

    struct Data;
    [[nodiscard]] const Data& data() const { return *data_; }

  private:
    std::unique_ptr<Data> data_;
};

/// Candidates are made from at least this many places, however early the search is stopped, so that
/// there is something to choose from. Takes milliseconds.
constexpr std::size_t kMinPlaces = 64;

/// Appends the candidates of all sites, in order: each site becomes one site of the set, with a
/// candidate for each heading (only the first if views.isRound()). Works in parallel on a few sites
/// at a time, so that memory stays close to that of the set; the result does not depend on the
/// number of threads. False if progress said stop: then the set has the sites scanned so far and
/// `least` of the others, or all, spread over the plan; in order. \throws UsageError once
/// set.bytes() is more than max_bytes
///
/// With results of steps, views stored there are taken, and others stored. A shard of the
/// candidates looks from its own sites alone: its candidates elsewhere see nothing.
bool addCandidates(PosedCandidates& set, const CandidateViews& views, std::span<const Site> sites,
                   std::size_t max_bytes, Progress& progress, std::size_t least = kMinPlaces,
                   const SearchShare& share = SearchShare());

/// The laser as a search scans with it at the thesis' "reso" (section 4.2): one scan of all it
/// sweeps, with beams `step` apart from its first one on; 0: its own step. Where it sees all around
/// the nearest step that divides a turn. \pre 0 <= step <= 90 degrees
Laser withBeamStep(Laser laser, Angle step);

/// The cells within the contour of a scan: centres strictly inside the polygon of the place and the
/// ends of all beams, at the first surface or else at max_range (section 4.5.2). If the beams close
/// the circle, of the ends alone. \pre the sensor is a laser
CellSet cellsByBeams(const Grid& grid, const RayWorld& world, const Sensor& sensor);

}  // namespace ispace
