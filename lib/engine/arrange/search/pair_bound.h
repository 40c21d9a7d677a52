// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange/search: overlapBound() and its relaxation. Closes part of the gap
// that lagrangianBound() leaves where many views overlap in pairs, at several times its cost;
// search() takes it for six sensors or more, if more than 0.5 % remains.
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
/// multipliers: one of each cell and, last, that of the number of sensors.
class OverlapRelaxation {
  public:
    /// \param near a solution; areas lie about its sensors. \pre not empty
    OverlapRelaxation(const Problem& problem, const Bound& plain, const std::vector<Choice>& near);

    [[nodiscard]] const RelaxedCells& cells() const { return cells_; }
    /// Returns the upper limits of the multipliers.
    [[nodiscard]] const std::vector<std::uint32_t>& limits() const { return limits_; }
    [[nodiscard]] const std::vector<std::uint32_t>& start() const { return start_; }

    /// Computes the bound for these multipliers, fine. Returns the maximum if progress says stop
    /// meanwhile, or if memory would run out. The members below refer to the last call.
    std::uint64_t evaluate(const std::vector<std::uint32_t>& multipliers, const Progress& progress);
    /// Computes the same from the working candidates alone: fast, and at most as high.
    std::uint64_t evaluateWorking(const std::vector<std::uint32_t>& multipliers,
                                  const Progress& progress);
    /// Returns by cell how often it counts; then the deficit of the number of sensors, as that of a
    /// cell.
    [[nodiscard]] const std::vector<float>& cover() const { return cover_; }
    /// After evaluate(): adds the most promising candidates to the working ones.
    void widen();

  private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    /// The multiplier of the number of sensors moves in steps of so many units: it acts on whole
    /// views, the others on a cell each.
    static constexpr std::uint32_t kNumberUnit = 10;

    /// A candidate that is worth more than the multiplier of the number of sensors.
    struct Place {
        std::uint32_t candidate = 0;
        std::int64_t worth = 0;  ///< its surplus over that multiplier
        // With the best other sensors of its area and of those below:
        std::int64_t value = 0;
        std::uint32_t second = kNone;  ///< another of the area: its rank there
        std::size_t count = 1;         ///< sensors in the area
        bool is_crowd = false;         ///< the sensors see the whole view of the area
    };

    /// Candidates with similar views: comparing with one of them excludes most of the others.
    struct Bundle {
        CellRuns common;                   ///< cells that all of them see
        std::uint64_t founder = 0;         ///< weight of the first one's view
        std::vector<std::uint32_t> ranks;  ///< of its current members, the best first
        std::int64_t best = 0;
    };

    /// Candidates of which a few sensors may be chosen.
    struct Area {
        std::size_t parent = 0;
        std::vector<std::size_t> below;
        std::vector<std::uint32_t> working;  ///< candidates
        std::vector<Bundle> bundles;
        std::vector<std::uint32_t> bundle_order;  ///< of the non-empty ones, the best first
        // Of the last call:
        std::vector<Place> places;         ///< the worthiest first
        std::vector<std::uint32_t> order;  ///< their ranks, the highest value first
        std::vector<std::vector<std::uint32_t>>
            replies;               ///< of each area below, by rank here; may be empty
        std::int64_t empty = 0;    ///< value without a sensor here
        std::int64_t crowded = 0;  ///< weight of the cells that any member sees
        std::vector<CellRun> all;  ///< those cells
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

/// Computes an upper bound below that of the linear program, for one kind of sensors that cover
/// cells one by one: cells that neighbours both see count only once.
///
/// Lagrangian relaxation of the cells' rows lets the multiplier of a cell count for every sensor
/// that sees it, so fractions of neighbours combine as no whole sensors can. Here candidates are
/// split into areas, one about each sensor of a good solution, and a spanning tree joins the areas.
/// The common cells of the first sensors of two joined areas are subtracted: of c sensors that see
/// a cell at most c - 1 pairs are edges, so it still counts at least once
/// (D. Hunter, An upper bound for the probability of a union, 1976). Within an
/// area two sensors are exact, and more of them at most see the union of its worthwhile views. The
/// number of sensors has a separate multiplier. A pass from the leaves of the tree to its root
/// finds the best choice for given multipliers exactly.
///
/// Integer arithmetic: the bound is exact. Deterministic for any number of threads.
/// \param plain of the same problem; its multipliers are the start of the search
/// \param near a good solution
/// \param limits as for lagrangianBound()
/// \return the lower of the two bounds, in the problem's units
std::uint64_t overlapBound(const Problem& problem, const Bound& plain,
                           const std::vector<Choice>& near, const LagrangeLimits& limits,
                           Progress& progress);

/// Returns true if overlapBound() supports such a problem.
bool isBoundByOverlaps(const Problem& problem);

}  // namespace ispace
