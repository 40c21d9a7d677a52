// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "place/best_place.h"
#include "place/connection.h"
#include "place/search.h"
#include "place/search_basis.h"

namespace ispace {

namespace {

/// One greedy placement.
class GreedyPlacement {
  public:
    GreedyPlacement(const SearchBasis& basis, bool per_cost, CoverageState& state,
                    Progress& progress)
        : basis_(basis),
          per_cost_(per_cost),
          state_(state),
          progress_(progress),
          bounds_(basis.site_parts),
          pending_(basis.problem.order) {}

    void run() {
        while (placeNext()) progress_.advance(1);
    }

  private:
    /// The kinds that may come next, best first where an order is asked for.
    [[nodiscard]] std::vector<std::size_t> nextKinds() const {
        std::vector<std::size_t> kinds = pending_;
        if (basis_.problem.order.empty()) {
            kinds.resize(basis_.problem.kinds.size());
            std::iota(kinds.begin(), kinds.end(), std::size_t{0});
        }
        const auto is_full = [this](std::size_t kind) {
            return !state_.canTake(kind, basis_.limits[kind]);
        };
        kinds.erase(std::remove_if(kinds.begin(), kinds.end(), is_full), kinds.end());
        return kinds;
    }

    bool placeNext() {
        const bool is_ordered = !basis_.problem.order.empty();
        BestPlace best;
        std::size_t best_kind = 0;
        for (const std::size_t kind : nextKinds()) {
            const BestPlace place = bestOf(kind);
            if (!place.is_found) continue;
            if (!best.is_found || isBetter(place, kind, best, best_kind)) {
                best = place;
                best_kind = kind;
            }
            if (is_ordered) break;
        }
        if (!best.is_found) return false;
        state_.add({best_kind, best.candidate});
        if (is_ordered) pending_.erase(std::find(pending_.begin(), pending_.end(), best_kind));
        return true;
    }

    [[nodiscard]] bool isBetter(const BestPlace& a, std::size_t kind_a, const BestPlace& b,
                                std::size_t kind_b) const {
        const std::vector<Kind>& kinds = basis_.problem.kinds;
        if (!per_cost_) return a.score > b.score;
        return static_cast<double>(a.score >> 32U) * kinds[kind_b].cost >
               static_cast<double>(b.score >> 32U) * kinds[kind_a].cost;
    }

    BestPlace bestOf(std::size_t kind) {
        const Problem& problem = basis_.problem;
        state_.price(kind, Measure::Parts, prices_);
        sums_.assign(prices_);
        std::optional<Connection> connection;
        if (problem.is_connected) connection.emplace(problem, state_.chosen());
        const auto allows = [&](std::size_t candidate) {
            const Choice choice{kind, candidate};
            return !state_.holds(choice) && (!connection || connection->isJoinedBy(choice));
        };
        BestPlace best = finder_.find({problem.kinds[kind].candidates, &sums_}, bounds_[kind], {},
                                      allows, progress_);
        // More sensors than candidates: each has a place all the same.
        if (!best.is_found && !connection) best.is_found = true;
        return best;
    }

    const SearchBasis& basis_;
    bool per_cost_;
    CoverageState& state_;
    Progress& progress_;
    std::vector<std::vector<std::uint32_t>> bounds_;  // per kind and site
    std::vector<std::size_t> pending_;                // with an order: kinds yet to come
    PlaceFinder finder_;
    std::vector<std::uint32_t> prices_;
    CellPrices sums_;
};

}  // namespace

void placeRest(const SearchBasis& basis, bool per_cost, CoverageState& state, Progress& progress) {
    GreedyPlacement(basis, per_cost, state, progress).run();
}

Solution placeGreedily(const Problem& problem, Progress& progress) {
    const SearchBasis basis(problem);
    const auto has_cost_of_first = [&](const Kind& kind) {
        return kind.cost == problem.kinds.front().cost;
    };
    const bool is_by_cost =
        problem.budget && problem.order.empty() &&
        !std::all_of(problem.kinds.begin(), problem.kinds.end(), has_cost_of_first);
    const std::int64_t sensors =
        std::accumulate(basis.limits.begin(), basis.limits.end(), std::int64_t{0});
    progress.begin("placing", is_by_cost ? 2 * sensors : sensors);
    CoverageState best = basis.emptyState();
    placeRest(basis, false, best, progress);
    if (is_by_cost) {
        CoverageState other = basis.emptyState();
        placeRest(basis, true, other, progress);
        if (std::pair(other.value(), other.parts()) > std::pair(best.value(), best.parts()))
            best = std::move(other);
    }
    progress.end();
    return {best.chosen(), best.value()};
}

}  // namespace ispace
