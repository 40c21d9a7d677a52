// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/local_search.h"

#include <algorithm>
#include <tuple>

#include "place/connection.h"

namespace ispace {

namespace {

/// Sensors whose bounds are kept apart: some 50 kB each.
constexpr std::size_t kMostSlots = 64;

/// What a local search makes better: more value, then more parts, then less cost.
using Rank = std::tuple<std::uint64_t, std::uint64_t, double>;

Rank rankOf(const CoverageState& state) {
    const double cost = state.problem().budget ? state.cost() : 0;
    return {state.value(), state.parts(), -cost};
}

}  // namespace

std::optional<Response> ResponseCache::find(const Key& others) const {
    const std::lock_guard lock(mutex_);
    const auto found = responses_.find(others);
    if (found == responses_.end()) return std::nullopt;
    return found->second;
}

void ResponseCache::store(const Key& others, const Response& response) {
    const std::lock_guard lock(mutex_);
    responses_.emplace(others, response);
}

LocalSearch::Slot& LocalSearch::slotAt(std::size_t position) {
    const std::size_t index = std::min(position, kMostSlots - 1);
    while (slots_.size() <= index) {
        if (!slots_.empty()) {
            // What is known of the sensors before holds in part for the next one, too.
            slots_.push_back(slots_.back());
            continue;
        }
        Slot& slot = slots_.emplace_back();
        slot.reserve(basis_.site_met.size());
        for (const auto& bounds : basis_.site_met) slot.push_back({{}, bounds});
    }
    return slots_[index];
}

void LocalSearch::renew(SiteBounds& known, std::size_t kind) const {
    if (known.prices.empty()) {
        known.prices = prices_;
        return;
    }
    // A candidate adds more than before by no more than all cells add together.
    std::uint64_t more = 0;
    for (std::size_t i = 0; i < prices_.size(); ++i)
        more += prices_[i] > known.prices[i] ? prices_[i] - known.prices[i] : 0U;
    known.prices = prices_;
    if (more == 0) return;
    const std::vector<std::uint32_t>& most = basis_.site_met[kind];
    const auto more32 = static_cast<std::uint32_t>(more);  // below the sum of all weights
    for (std::size_t site = 0; site < most.size(); ++site) {
        const std::uint32_t left = most[site] - std::min(most[site], known.bounds[site]);
        known.bounds[site] = most[site] - (left > more32 ? left - more32 : 0U);
    }
}

BestPlace LocalSearch::bestOf(const CoverageState& others, std::size_t kind, SiteBounds& bounds,
                              const BestPlace& known) {
    const Problem& problem = basis_.problem;
    others.price(kind, Measure::Met, prices_);
    renew(bounds, kind);
    sums_.assign(prices_);
    const bool has_parts = problem.demand > 1;
    if (has_parts) {
        others.price(kind, Measure::Parts, more_prices_);
        more_sums_.assign(more_prices_);
    }
    std::optional<Connection> connection;
    if (problem.is_connected) connection.emplace(problem, others.chosen());
    const auto allows = [&](std::size_t candidate) {
        const Choice choice{kind, candidate};
        return !others.holds(choice) && (!connection || connection->isJoinedBy(choice));
    };
    return finder_.find({problem.kinds[kind].candidates, &sums_, has_parts ? &more_sums_ : nullptr},
                        bounds.bounds, known, allows, progress_);
}

Response LocalSearch::respond(const CoverageState& others, Slot& slot,
                              const std::optional<Response>& known) {
    ResponseCache::Key key = others.chosen();
    std::sort(key.begin(), key.end());
    if (const auto response = cache_.find(key)) return *response;
    const std::vector<Kind>& kinds = basis_.problem.kinds;
    Response best;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        if (!others.canTake(kind, basis_.limits[kind])) continue;
        BestPlace start;
        if (known && known->choice.kind == kind)
            start = {known->choice.candidate, known->score, true};
        const BestPlace place = bestOf(others, kind, slot[kind], start);
        if (!place.is_found) continue;
        const bool is_better =
            !best.is_found || place.score > best.score ||
            (place.score == best.score && kinds[kind].cost < kinds[best.choice.kind].cost);
        if (is_better) best = {{kind, place.candidate}, place.score, true};
    }
    if (!progress_.stopped()) cache_.store(key, best);
    return best;
}

bool LocalSearch::move(CoverageState& state, std::size_t position) {
    const Rank before = rankOf(state);
    const std::uint64_t value = state.value(), parts = state.parts();
    const Choice choice = state.chosen()[position];
    state.removeAt(position);
    std::optional<Response> known;
    if (!state.holds(choice)) {
        const std::uint64_t second = basis_.problem.demand > 1 ? parts - state.parts() : 0;
        known = Response{choice, (value - state.value()) << 32U | second, true};
    }
    const Response response = respond(state, slotAt(position), known);
    if (response.is_found && response.choice != choice) {
        state.insert(position, response.choice);
        if (rankOf(state) > before) return true;
        state.removeAt(position);
    }
    state.insert(position, choice);
    return false;
}

bool LocalSearch::add(CoverageState& state) {
    std::size_t kind = 0;
    while (kind < basis_.limits.size() && !state.canTake(kind, basis_.limits[kind])) ++kind;
    if (kind == basis_.limits.size()) return false;
    Response response = respond(state, slotAt(state.chosen().size()), std::nullopt);
    // More sensors than candidates: each has a place all the same.
    if (!response.is_found && !basis_.problem.is_connected) response = {{kind, 0}, 0, true};
    if (response.is_found) state.add(response.choice);
    return response.is_found;
}

void LocalSearch::fill(CoverageState& state) {
    while (add(state)) {
    }
}

bool LocalSearch::rebuyWithout(CoverageState& state, const std::vector<std::size_t>& positions) {
    const Rank before = rankOf(state);
    CoverageState rest = state;
    for (auto position = positions.rbegin(); position != positions.rend(); ++position)
        rest.removeAt(*position);
    for (std::size_t kind = 0; kind < basis_.limits.size(); ++kind) {
        if (!rest.canTake(kind, basis_.limits[kind])) continue;
        CoverageState other = rest;
        const BestPlace place = bestOf(other, kind, slotAt(positions.front())[kind], {});
        if (!place.is_found) continue;
        other.add({kind, place.candidate});
        fill(other);
        if (rankOf(other) > before) {
            state = other;
            return true;
        }
    }
    return false;
}

bool LocalSearch::rebuy(CoverageState& state) {
    const std::size_t count = state.chosen().size();
    for (std::size_t a = 0; a < count; ++a) {
        if (progress_.stopped()) return false;
        if (rebuyWithout(state, {a})) return true;
        for (std::size_t b = a + 1; b < count; ++b)
            if (rebuyWithout(state, {a, b})) return true;
    }
    return false;
}

void LocalSearch::improve(CoverageState& state) {
    const std::vector<Kind>& kinds = basis_.problem.kinds;
    const bool is_by_cost = basis_.problem.budget && !kinds.empty() &&
                            std::any_of(kinds.begin(), kinds.end(), [&](const Kind& kind) {
                                return kind.cost != kinds.front().cost;
                            });
    do {
        add(state);
        std::size_t unmoved = 0;  // since the last move
        for (std::size_t i = 0; unmoved < state.chosen().size() && !progress_.stopped(); ++i)
            unmoved = move(state, i % state.chosen().size()) ? 0 : unmoved + 1;
    } while (is_by_cost && rebuy(state));
    fill(state);
}

}  // namespace ispace
