// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/arrange/search only: what overlapBound() evaluates.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "arrange/search/cover_sets.h"
#include "arrange/search/problem.h"
#include "arrange/search/relaxation.h"
#include "base/cell_set.h"
#include "base/error.h"

namespace ispace {

/// The relaxation of overlapBound(): areas of candidates in a tree, and their best choice for given
/// multipliers. These are one of each cell and, last, that of the number of sensors.
class OverlapRelaxation {
  public:
    /// \param near a solution; areas lie about its sensors. \pre not empty
    OverlapRelaxation(const Problem& problem, const Bound& plain, const std::vector<Choice>& near);

    [[nodiscard]] const RelaxedCells& cells() const { return cells_; }
    /// What multipliers are limited by.
    [[nodiscard]] const std::vector<std::uint32_t>& limits() const { return limits_; }
    [[nodiscard]] const std::vector<std::uint32_t>& start() const { return start_; }

    /// The bound for these multipliers, fine. No limit if progress says stop meanwhile, or there
    /// would be too much to keep. The members below refer to the last call.
    std::uint64_t evaluate(const std::vector<std::uint32_t>& multipliers, const Progress& progress);
    /// The same as if there were the working candidates alone: quick, and at most as high.
    std::uint64_t evaluateWorking(const std::vector<std::uint32_t>& multipliers,
                                  const Progress& progress);
    /// By cell how often it counts; then what the number of sensors lacks, as that of a cell.
    [[nodiscard]] const std::vector<float>& cover() const { return cover_; }
    /// After evaluate(): the most promising candidates join the working ones.
    void widen();

  private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    /// The multiplier of the number of sensors moves in steps of so many units: it acts on whole
    /// views, the others on a cell each.
    static constexpr std::uint32_t kNumberUnit = 10;

    /// A candidate that is worth more than the multiplier of the number of sensors.
    struct Place {
        std::uint32_t candidate = 0;
        std::int64_t worth = 0;  ///< by how much
        // With what else is in its area and in those below, at best:
        std::int64_t value = 0;
        std::uint32_t second = kNone;  ///< another of the area: its rank there
        std::size_t count = 1;         ///< sensors in the area
        bool is_crowd = false;         ///< they see all that any of the area sees
    };

    /// Places that see much the same, so that most are told from a best one together.
    struct Bundle {
        CellRuns common;                   ///< what all of them see
        std::uint64_t founder = 0;         ///< weight of what the first of them sees
        std::vector<std::uint32_t> ranks;  ///< of the places that are in it now, the best first
        std::int64_t best = 0;
    };

    /// Candidates of which a few sensors may be chosen.
    struct Area {
        std::size_t parent = 0;
        std::vector<std::size_t> below;
        std::vector<std::uint32_t> working;  ///< candidates
        std::vector<Bundle> bundles;
        std::vector<std::uint32_t> bundle_order;  ///< of those with places, the best first
        // Of the last call:
        std::vector<Place> places;         ///< the worthiest first
        std::vector<std::uint32_t> order;  ///< their ranks, the highest value first
        std::vector<std::vector<std::uint32_t>>
            replies;               ///< of each area below, by rank here; or none
        std::int64_t empty = 0;    ///< value without a sensor here
        std::int64_t crowded = 0;  ///< weight of what any place sees
        std::vector<CellRun> all;  ///< that is
        std::uint32_t best = kNone;
        [[nodiscard]] std::int64_t value() const {
            return order.empty() ? empty : std::max(empty, places[order[0]].value);
        }
    };

    void join(std::uint32_t least);
    const CellRuns& viewOf(std::uint32_t candidate);
    void addToBundle(std::uint32_t candidate);
    void findPlaces(const std::vector<std::uint32_t>& multipliers, bool is_all);
    void findCrowd(Area& area, const std::vector<std::uint32_t>& multipliers) const;
    std::uint64_t boundOf(const std::vector<std::uint32_t>& multipliers, bool is_all,
                          const Progress& progress);
    void gather(Area& area, const std::vector<std::uint32_t>& multipliers);
    std::int64_t reply(const Area& from, const MaskedSums& seen, std::uint32_t& rank) const;
    void fillArea(const Area& area, std::size_t rank, const MaskedSums& seen, Place& place) const;
    template <typename Value>
    void sortBundles(Area& area, Value value) const;
    void choose();
    void setCover();
    [[nodiscard]] const CellRuns& seenFrom(const Place& place) const {
        return views_[view_of_[place.candidate]];
    }

    RelaxedCells cells_;
    const CandidateSet& set_;
    std::size_t sensors_;
    std::vector<std::uint32_t> view_of_;  // by candidate
    std::vector<CellRuns> views_;
    std::vector<std::uint32_t> bundle_of_;  // by view
    MaskedSums seen_;                       // scratch
    std::vector<std::uint32_t> weights_;    // of candidates
    std::vector<std::uint32_t> limits_, start_;
    std::vector<std::uint32_t> area_of_;  // by candidate
    std::vector<Area> areas_;
    std::vector<std::size_t> from_root_;  // areas, parents first
    std::int64_t number_ = 0;             // multiplier of the number of sensors
    std::vector<float> cover_;
};

/// An upper bound below that of the linear program, where one kind of sensors covers cells one by
/// one: it knows that neighbours count what both see only once.
///
/// Lagrangian relaxation of the cells' rows lets the multiplier of a cell count for every sensor
/// that sees it, so fractions of neighbours combine as no whole sensors can. Here candidates are
/// parted into areas, one about each sensor of a good solution, and a spanning tree joins the
/// areas. What the first sensors of two joined areas both see is taken off: of c sensors that see a
/// cell at most c - 1 pairs are edges, so it still counts at least once (Hunter 1976). Within an
/// area two sensors are exact, and more of them at most see all that any candidate of worth there
/// sees. The number of sensors has a multiplier of its own. The best choice for given multipliers
/// is found exactly, from the leaves of the tree to its root.
///
/// Integer arithmetic: the bound is exact. The same for any number of threads.
/// \param plain of the same problem; its multipliers are where the search begins
/// \param near a good solution
/// \param limits as for lagrangianBound()
/// \return the lower of the two bounds, in the problem's units
std::uint64_t overlapBound(const Problem& problem, const Bound& plain,
                           const std::vector<Choice>& near, const LagrangeLimits& limits,
                           Progress& progress);

/// True if overlapBound() can do anything for such a problem.
bool isBoundByOverlaps(const Problem& problem);

}  // namespace ispace
