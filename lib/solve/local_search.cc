// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/local_search.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/random.h"
#include "solve/problem.h"

namespace ispace {

namespace {

/// Sensors whose bounds are kept apart, and the bytes that these may take on all threads together:
/// 4 a cell and a site of each kind.
constexpr std::size_t kMaxSlots = 64;
constexpr std::size_t kMaxSlotBytes = 256'000'000;
constexpr std::size_t kMaxResponses = 100'000;
/// Pairs are made of so many sensors, and so many pairs are tried.
constexpr std::size_t kPairSensors = 16;
constexpr int kMaxPairs = 400;

/// What a local search makes better: more value, then more parts, then less cost.
using Rank = std::tuple<std::uint64_t, std::uint64_t, double>;

Rank rankOf(const CoverageState& state) {
    const double cost = state.problem().budget ? state.cost() : 0;
    return {state.value(), state.partialValue(), -cost};
}

std::size_t slotsFor(const SearchBasis& basis) {
    std::size_t words = 1;
    for (const auto& sites : basis.site_full) words += basis.problem.cells() + sites.size();
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    return std::clamp<std::size_t>(kMaxSlotBytes / (4 * words * threads), 1, kMaxSlots);
}

bool haveCostsThatDiffer(const Problem& problem) {
    return std::any_of(problem.kinds.begin(), problem.kinds.end(),
                       [&](const Kind& kind) { return kind.cost != problem.kinds.front().cost; });
}

}  // namespace

ResponseCache::Key::Key(const std::vector<Choice>& chosen) {
    // Sums: in any order, and a choice that is there twice does not cancel out.
    for (const Choice& choice : chosen) {
        const std::uint64_t bits = mixedBits(mixedBits(choice.kind) + choice.candidate);
        first += bits;
        second += mixedBits(bits);
    }
}

std::optional<Response> ResponseCache::find(const Key& others) const {
    const std::lock_guard lock(mutex_);
    const auto found = responses_.find(others);
    if (found == responses_.end()) return std::nullopt;
    return found->second;
}

void ResponseCache::store(const Key& others, const Response& response) {
    const std::lock_guard lock(mutex_);
    if (responses_.size() < kMaxResponses) responses_.emplace(others, response);
}

LocalSearch::LocalSearch(const SearchBasis& basis, ResponseCache& cache, std::uint64_t enough,
                         const Progress& progress)
    : basis_(basis),
      cache_(cache),
      enough_(enough),
      progress_(progress),
      is_by_cost_(basis.problem.budget && haveCostsThatDiffer(basis.problem)),
      max_slots_(slotsFor(basis)) {}

LocalSearch::Slot& LocalSearch::slotAt(std::size_t position) {
    const std::size_t index = std::min(position, max_slots_ - 1);
    while (slots_.size() <= index) {
        if (!slots_.empty()) {
            // What is known of the sensors before holds in part for the next one, too.
            slots_.push_back(slots_.back());
            continue;
        }
        Slot& slot = slots_.emplace_back();
        slot.reserve(basis_.site_full.size());
        for (const auto& bounds : basis_.site_full) slot.push_back({{}, bounds});
    }
    return slots_[index];
}

void LocalSearch::renew(SiteBounds& known, std::size_t kind) const {
    if (known.gains.empty()) {
        known.gains = gains_;
        return;
    }
    // A candidate adds more than before by no more than all cells add together.
    std::uint64_t more = 0;
    for (std::size_t i = 0; i < gains_.size(); ++i)
        more += gains_[i] > known.gains[i] ? gains_[i] - known.gains[i] : 0U;
    known.gains = gains_;
    if (more == 0) return;
    const std::vector<std::uint32_t>& most = basis_.site_full[kind];
    const auto more32 = static_cast<std::uint32_t>(more);  // below the sum of all weights
    for (std::size_t site = 0; site < most.size(); ++site) {
        const std::uint32_t left = most[site] - std::min(most[site], known.bounds[site]);
        known.bounds[site] = most[site] - (left > more32 ? left - more32 : 0U);
    }
}

BestCandidate LocalSearch::bestOf(const CoverageState& others, std::size_t kind, SiteBounds& bounds,
                                  const BestCandidate& known) {
    const Problem& problem = basis_.problem;
    others.marginalGains(kind, Measure::Full, gains_);
    renew(bounds, kind);
    sums_.assign(gains_);
    const bool has_parts = problem.required > 1;
    if (has_parts) {
        others.marginalGains(kind, Measure::Partial, more_gains_);
        more_sums_.assign(more_gains_);
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
    const ResponseCache::Key key(others.chosen());
    if (const auto response = cache_.find(key)) return *response;
    const std::vector<Kind>& kinds = basis_.problem.kinds;
    Response best;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        if (!others.canTake(kind, basis_.limits[kind])) continue;
        BestCandidate start;
        if (known && known->choice.kind == kind)
            start = {known->choice.candidate, known->score, true};
        const BestCandidate place = bestOf(others, kind, slot[kind], start);
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
    const std::uint64_t value = state.value(), parts = state.partialValue();
    const Choice choice = state.chosen()[position];
    state.removeAt(position);
    std::optional<Response> known;
    if (!state.holds(choice)) {
        const std::uint64_t second = basis_.problem.required > 1 ? parts - state.partialValue() : 0;
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
        const BestCandidate place = bestOf(other, kind, slotAt(positions.front())[kind], {});
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

bool LocalSearch::rebuyOne(CoverageState& state) {
    for (std::size_t i = 0; i < state.chosen().size() && !isOver(state); ++i)
        if (rebuyWithout(state, {i})) return true;
    return false;
}

/// Positions of the sensors without which least is lost for what they cost, ascending.
std::vector<std::size_t> LocalSearch::leastUseful(const CoverageState& state) const {
    std::vector<std::pair<double, std::size_t>> losses;
    losses.reserve(state.chosen().size());
    CoverageState rest = state;
    for (std::size_t i = 0; i < state.chosen().size(); ++i) {
        const Choice choice = state.chosen()[i];
        rest.removeAt(i);
        const auto loss = static_cast<double>(state.value() - rest.value());
        losses.emplace_back(loss / basis_.problem.kinds[choice.kind].cost, i);
        rest.insert(i, choice);
    }
    std::sort(losses.begin(), losses.end());
    std::vector<std::size_t> least;
    least.reserve(kPairSensors);
    for (std::size_t i = 0; i < std::min(losses.size(), kPairSensors); ++i)
        least.push_back(losses[i].second);
    std::sort(least.begin(), least.end());
    return least;
}

bool LocalSearch::rebuyTwo(CoverageState& state, int& tries) {
    const std::vector<std::size_t> positions = leastUseful(state);
    for (std::size_t a = 0; a < positions.size(); ++a)
        for (std::size_t b = a + 1; b < positions.size(); ++b) {
            if (tries-- <= 0 || isOver(state)) return false;
            if (rebuyWithout(state, {positions[a], positions[b]})) return true;
        }
    return false;
}

void LocalSearch::moveAll(CoverageState& state) {
    add(state);
    std::size_t unmoved = 0;  // since the last move
    for (std::size_t i = 0; unmoved < state.chosen().size() && !isOver(state); ++i)
        unmoved = move(state, i % state.chosen().size()) ? 0 : unmoved + 1;
}

void LocalSearch::improve(CoverageState& state) {
    do moveAll(state);
    while (is_by_cost_ && rebuyOne(state));
    fill(state);
}

void LocalSearch::improveByPairs(CoverageState& state) {
    int tries = is_by_cost_ ? kMaxPairs : 0;
    do improve(state);
    while (rebuyTwo(state, tries));
}

}  // namespace ispace
