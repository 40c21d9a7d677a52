// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "base/progress.h"
#include "cover/sight.h"
#include "place/posed_candidates.h"
#include "place/sites.h"
#include "raster/grid.h"

namespace ispace {

/// What a kind of sensor sees of the cells of a grid from anywhere, mounted at one height with one
/// tilt and roll: the same cells as Sight::cellsOf() for a sensor there. Thread-safe.
class CandidateViews {
  public:
    /// Keeps references.
    /// \param mount its height, tilt and roll count, its place and heading do not
    /// \param counted cells that weigh something, if not all do: candidates then see these as
    ///        they should, and others or not as it comes, which makes them smaller
    CandidateViews(const Sight& sight, const Grid& grid, const SensorModel& device,
                   const Pose3& mount, const CellSet* counted = nullptr);
    ~CandidateViews();
    CandidateViews(const CandidateViews&) = delete;
    CandidateViews& operator=(const CandidateViews&) = delete;

    /// True if what it sees does not depend on its heading: a laser that looks all around, a cone
    /// that looks straight down. Only the first heading of a site is then worth a candidate.
    [[nodiscard]] bool isRound() const;

    struct Data;
    [[nodiscard]] const Data& data() const { return *data_; }

  private:
    std::unique_ptr<const Data> data_;
};

/// From so many places at least candidates are made, however early one stops: something to choose
/// from, which takes milliseconds where a slice is looked at.
constexpr std::size_t kLeastPlaces = 64;

/// Appends the candidates of all sites, in order: of each its headings (only the first if
/// views.isRound()) are the candidates of one site of the set. The work is shared out over all
/// cores, some sites at a time, so that hardly more memory is needed than the set takes; the result
/// does not depend on the number of threads. Sites all over the list are looked at first. False if
/// progress said to stop: then those that were done are there, in order, at least `least` of them
/// (or all), spread over the list. \throws UsageError once set.bytes() is more than most_bytes
bool addCandidates(PosedCandidates& set, const CandidateViews& views, std::span<const Site> sites,
                   std::size_t most_bytes, Progress& progress, std::size_t least = kLeastPlaces);

}  // namespace ispace
