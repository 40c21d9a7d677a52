// SPDX-License-Identifier: GPL-3.0-or-later
// Greedy placement, lazily (M. Minoux, Accelerated greedy algorithms for maximizing submodular set
// functions, 1978).
//
// If one sensor covers a cell, gains only fall as sensors are added: an old gain bounds a new one,
// and few sites are weighed. If a cell requires several, gains also rise. A cell then counts by its
// weight over the number of sensors that it lacks, 0 if too few are left, and the bound of a site
// rises by the rises of all cells in its span. With a budget and different costs, placements by
// gain and by gain for cost are both made, and the better one is taken (J. Leskovec, A. Krause, C.
// Guestrin, C. Faloutsos, J. VanBriesen, N. Glance, Cost-effective outbreak detection in networks,
// 2007).
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "arrange/search/greedy_search.h"
#include "arrange/search/problem.h"
#include "arrange/search/search.h"

namespace ispace {

namespace {

/// So many sensors are placed with care even if progress says stop: compared with building the
/// candidates this takes little time.
constexpr std::size_t kSureSensors = 32;

/// Rules of a greedy placement.
struct GreedyRule {
    bool by_parts = false;         ///< by partial gain
    bool per_cost = false;         ///< by gain for cost
    std::size_t sure_sensors = 0;  ///< so many regardless of progress
};

/// Computes the span from the first to the last cell that each site sees. O(runs), on all cores
std::vector<CellRun> spansOf(const CandidateSet& candidates) {
    std::vector<CellRun> spans(candidates.sites());
    tbb::parallel_for(std::size_t{0}, spans.size(), [&](std::size_t site) {
        CellRun span{std::numeric_limits<std::uint32_t>::max(), 0};
        for (std::size_t part = 0; part <= candidates.directedParts(site); ++part)
            for (const CellRun& run : candidates.runsOf(site, part))
                span = {std::min(span.first, run.first), std::max(span.end, run.end)};
        spans[site] = span.first < span.end ? span : CellRun{0, 0};
    });
    return spans;
}

/// One greedy placement.
class GreedyPlacement {
  public:
    GreedyPlacement(const SearchBasis& basis, const GreedyRule& rule, CoverageState& state,
                    Progress& progress)
        : basis_(basis),
          rule_(rule),
          state_(state),
          progress_(progress),
          has_steps_(!rule.by_parts && takesSteps(basis.problem)),
          known_(basis.problem.kinds.size()),
          pending_(basis.problem.order) {}

    void run() {
        while (placeNext()) progress_.advance(1);
    }

  private:
    /// Cached gains of the sites of a kind.
    struct KnownSites {
        std::vector<std::uint32_t> gains;   ///< from the last evaluation; of steps only
        std::vector<std::uint32_t> bounds;  ///< empty: unknown
        std::vector<CellRun> spans;         ///< of each site's view; of steps only
    };

    /// Returns the kinds that may come next, the best first if an order is given.
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

    /// Ties go to the first kind, and within it to the first candidate.
    bool placeNext() {
        const bool is_ordered = !basis_.problem.order.empty();
        BestCandidate best;
        std::size_t best_kind = 0;
        for (const std::size_t kind : nextKinds()) {
            const BestCandidate place = bestOf(kind);
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

    [[nodiscard]] bool isBetter(const BestCandidate& a, std::size_t kind_a, const BestCandidate& b,
                                std::size_t kind_b) const {
        if (!rule_.per_cost) return a.score > b.score;
        const double cost_a = basis_.problem.kinds[kind_a].cost,
                     cost_b = basis_.problem.kinds[kind_b].cost;
        const auto times = [](Score score, double cost) {
            constexpr Score kLow = std::numeric_limits<std::uint32_t>::max();
            return std::pair(static_cast<double>(score >> 32U) * cost,
                             static_cast<double>(score & kLow) * cost);
        };
        return times(a.score, cost_b) > times(b.score, cost_a);
    }

    /// Sensors that may be placed after one more of a kind, all with equal cost and share.
    struct Offer {
        double cost = 0;
        std::uint64_t multiplicity = 0, count = 0;
    };
    [[nodiscard]] std::vector<Offer> offersAfter(std::size_t kind) const {
        const Problem& problem = basis_.problem;
        std::vector<Offer> offers;
        offers.reserve(problem.kinds.size());
        for (std::size_t k = 0; k < problem.kinds.size(); ++k) {
            std::ptrdiff_t count = problem.order.empty()
                                       ? basis_.limits[k] - state_.count(k)
                                       : std::count(pending_.begin(), pending_.end(), k);
            if (k == kind) --count;
            if (count <= 0) continue;
            const int multiplicity = std::min(problem.kinds[k].multiplicity, problem.required);
            offers.push_back({problem.kinds[k].cost, static_cast<std::uint64_t>(multiplicity),
                              static_cast<std::uint64_t>(count)});
        }
        return offers;
    }

    /// Computes the maximum that sensors after one more of a kind can add to the multiplicity of a
    /// cell.
    [[nodiscard]] std::uint64_t multiplicityAfter(std::size_t kind) const {
        std::vector<Offer> offers = offersAfter(kind);
        std::uint64_t multiplicities = 0;
        const std::optional<double>& budget = basis_.problem.budget;
        if (!budget) {
            for (const Offer& offer : offers) multiplicities += offer.multiplicity * offer.count;
            return multiplicities;
        }
        // Sorts by multiplicity per cost, the last offer taken in part: this is the maximum.
        std::sort(offers.begin(), offers.end(), [](const Offer& a, const Offer& b) {
            return static_cast<double>(a.multiplicity) * b.cost >
                   static_cast<double>(b.multiplicity) * a.cost;
        });
        double spent = state_.cost() + basis_.problem.kinds[kind].cost;
        for (const Offer& offer : offers) {
            const double cost_of_part = offer.cost / static_cast<double>(offer.multiplicity);
            const std::size_t all = offer.multiplicity * offer.count;
            const std::size_t parts = affordableCount(*budget, spent, cost_of_part, all);
            multiplicities += parts;
            if (parts < all) break;
            spent += offer.cost * static_cast<double>(offer.count);
        }
        return multiplicities;
    }

    /// Updates the upper bounds of the gains of this sensor. If one sensor covers a cell, gains
    /// only fall and earlier bounds hold (Minoux 1978). Step gains rise as sensors are placed: the
    /// bound of a site then rises by that of all cells in its span.
    void renew(KnownSites& known, std::size_t kind) {
        const CandidateSet& candidates = *basis_.problem.kinds[kind].candidates;
        if (!has_steps_) {
            if (known.bounds.empty())
                known.bounds = rule_.by_parts ? basis_.site_partial[kind] : basis_.site_full[kind];
            return;
        }
        if (known.bounds.empty()) {
            std::vector<std::uint32_t> values(candidates.size());
            candidates.weighAll(sums_, values);
            known.spans = spansOf(candidates);
            known.bounds = maxOfSites(candidates, values);
        } else {
            std::vector<std::uint32_t>& rises = known.gains;
            for (std::size_t i = 0; i < rises.size(); ++i)
                rises[i] = gains_[i] - std::min(gains_[i], rises[i]);
            rise_sums_.assign(rises);
            for (std::size_t site = 0; site < known.bounds.size(); ++site) {
                const std::uint32_t bound = known.bounds[site];
                known.bounds[site] = bound + std::min(~bound, rise_sums_.of(known.spans[site]));
            }
        }
        known.gains = gains_;
    }

    BestCandidate bestOf(std::size_t kind) {
        const Problem& problem = basis_.problem;
        if (has_steps_) {
            state_.stepGains(kind, multiplicityAfter(kind), gains_);
            state_.marginalGains(kind, Measure::Partial, parts_);
            part_sums_.assign(parts_);
        } else {
            state_.marginalGains(kind, rule_.by_parts ? Measure::Partial : Measure::Full, gains_);
        }
        sums_.assign(gains_);
        renew(known_[kind], kind);
        std::optional<Connection> connection;
        if (problem.is_connected) connection.emplace(problem, state_.chosen());
        const auto allows = [&](std::size_t candidate) {
            const Choice choice{kind, candidate};
            return !state_.holds(choice) && (!connection || connection->isJoinedBy(choice));
        };
        SilentProgress never;
        const bool is_sure = state_.chosen().size() < rule_.sure_sensors;
        const Progress& progress = is_sure ? static_cast<const Progress&>(never) : progress_;
        BestCandidate best = finder_.find(
            {problem.kinds[kind].candidates, &sums_, has_steps_ ? &part_sums_ : nullptr},
            known_[kind].bounds, {}, allows, progress);
        // With more sensors than candidates, a sensor repeats a candidate.
        if (!best.is_found && !connection) best.is_found = true;
        return best;
    }

    const SearchBasis& basis_;
    GreedyRule rule_;
    CoverageState& state_;
    Progress& progress_;
    bool has_steps_;                    // it takes several sensors of a kind to cover a cell
    std::vector<KnownSites> known_;     // per kind
    std::vector<std::size_t> pending_;  // with an order: kinds yet to come
    CandidateFinder finder_;
    std::vector<std::uint32_t> gains_, parts_;
    WeightSums sums_, part_sums_, rise_sums_;
};

}  // namespace

void placeRest(const SearchBasis& basis, bool per_cost, CoverageState& state, Progress& progress) {
    GreedyPlacement(basis, {true, per_cost, 0}, state, progress).run();
}

/// With a budget alone (one sensor covers a cell, no limits of kinds, no connection, no stop) the
/// better of both rules has at least (1 - 1/e)/2 of the best value (Leskovec et al. 2007).
Solution placeGreedily(const Problem& problem, Progress& progress) {
    const SearchBasis basis(problem);
    const auto has_cost_of_first = [&](const SensorType& kind) {
        return kind.cost == problem.kinds.front().cost;
    };
    const bool is_by_cost =
        problem.budget && problem.order.empty() &&
        !std::all_of(problem.kinds.begin(), problem.kinds.end(), has_cost_of_first);
    const std::int64_t sensors =
        std::accumulate(basis.limits.begin(), basis.limits.end(), std::int64_t{0});
    progress.begin("placing", is_by_cost ? 2 * sensors : sensors);
    CoverageState best = basis.emptyState();
    GreedyPlacement(basis, {false, false, kSureSensors}, best, progress).run();
    if (is_by_cost) {
        CoverageState other = basis.emptyState();
        GreedyPlacement(basis, {false, true, kSureSensors}, other, progress).run();
        if (std::pair(other.value(), other.partialValue()) >
            std::pair(best.value(), best.partialValue()))
            best = std::move(other);
    }
    progress.end();
    return {best.chosen(), best.value()};
}

}  // namespace ispace
