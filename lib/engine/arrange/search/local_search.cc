// SPDX-License-Identifier: GPL-3.0-or-later
// Best responses: one sensor is removed and put where it gains most over all others, until no
// sensor moves; then kicks (H. R. Lourenço, O. C. Martin, T. Stützle, Iterated local search, 2003).
//
// Most of the time goes into finding the best candidate again after little has changed. Each
// position in the solution keeps bounds of the sites' gains: they rise by the rises of the cells in
// view, by blocks (site_blocks.h), and fall to what blocks allow. Responses are cached by a hash of
// 128 bits of the other sensors; a false hit would cost a move, never a wrong value, as values are
// recomputed.
#include "arrange/search/local_search.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "arrange/search/problem.h"
#include "base/random.h"
#include "base/simd.h"

namespace ispace {

namespace {

/// Maximum number of sensors with separate bounds, and the bytes that these may take on all threads
/// together: 4 a cell and a site of each kind.
constexpr std::size_t kMaxSlots = 64;
constexpr std::size_t kMaxSlotBytes = 256'000'000;
constexpr std::size_t kMaxResponses = 100'000;
/// Number of sensors that form pairs, and number of pairs tried.
constexpr std::size_t kPairSensors = 16;
constexpr int kMaxPairs = 400;

/// Rank of a local search: more value, then more parts, then less cost.
using Rank = std::tuple<std::uint64_t, std::uint64_t, double>;

Rank rankOf(const CoverageState& state) {
    const double cost = state.problem().budget ? state.cost() : 0;
    return {state.value(), state.partialValue(), -cost};
}

/// Bounds of all positions need memory on each thread; positions that exceed it share the last
/// slot.
std::size_t slotsFor(const SearchBasis& basis) {
    std::size_t words = 1;
    for (const auto& sites : basis.site_full) words += basis.problem.cells() + sites.size();
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    return std::clamp<std::size_t>(kMaxSlotBytes / (4 * words * threads), 1, kMaxSlots);
}

bool haveCostsThatDiffer(const Problem& problem) {
    return std::any_of(problem.kinds.begin(), problem.kinds.end(), [&](const SensorType& kind) {
        return kind.cost != problem.kinds.front().cost;
    });
}

}  // namespace

ResponseCache::Key::Key(const std::vector<Choice>& chosen) {
    // A sum: independent of order, and duplicate choices do not cancel out.
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

namespace {

/// Sets what the gains of cells rise by, 0 where they fall; returns true if any rises.
ISPACE_SIMD_CLONES bool setRises(const std::uint32_t* now, const std::uint32_t* before,
                                 std::uint32_t* rises, std::size_t cells) {
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < cells; ++i) {
        rises[i] = std::max(now[i], before[i]) - before[i];
        any |= rises[i];
    }
    return any != 0;
}

/// Raises bounds by these rises, to at most `full`.
ISPACE_SIMD_CLONES void raise(const std::uint32_t* full, const std::uint32_t* rises,
                              std::uint32_t* bounds, std::size_t sites) {
    for (std::size_t site = 0; site < sites; ++site) {
        const std::uint32_t left = full[site] - std::min(full[site], bounds[site]);
        bounds[site] = full[site] - (std::max(left, rises[site]) - rises[site]);
    }
}

ISPACE_SIMD_CLONES void lower(const std::uint32_t* most, std::uint32_t* bounds, std::size_t sites) {
    for (std::size_t site = 0; site < sites; ++site)
        bounds[site] = std::min(bounds[site], most[site]);
}

}  // namespace

LocalSearch::Slot& LocalSearch::slotAt(std::size_t position) {
    const std::size_t index = std::min(position, max_slots_ - 1);
    while (slots_.size() <= index) {
        if (!slots_.empty()) {
            // Bounds for the previous sensors hold in part for the next one, too.
            slots_.push_back(slots_.back());
            continue;
        }
        Slot& slot = slots_.emplace_back();
        slot.reserve(basis_.site_full.size());
        for (const auto& bounds : basis_.site_full) slot.push_back({{}, bounds});
    }
    return slots_[index];
}

/// Bounds stay valid for any change of the other sensors, in whatever order positions are tried.
void LocalSearch::renew(SiteBounds& known, std::size_t kind) {
    const SiteBlocks& blocks = basis_.site_blocks[kind];
    most_.resize(known.bounds.size());
    if (!known.gains.empty()) {
        // A candidate's gain rises by at most the sum over the cells that it sees.
        rises_.resize(gains_.size());
        if (setRises(gains_.data(), known.gains.data(), rises_.data(), gains_.size())) {
            blocks.bound(rises_, most_);
            raise(basis_.site_full[kind].data(), most_.data(), known.bounds.data(), most_.size());
        }
    }
    known.gains = gains_;
    blocks.bound(gains_, most_);
    lower(most_.data(), known.bounds.data(), most_.size());
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

/// The cache is shared by threads. A response depends on the set of the others alone, so it makes
/// results no less repeatable; those found after a stop are not kept.
Response LocalSearch::respond(const CoverageState& others, Slot& slot,
                              const std::optional<Response>& known) {
    const ResponseCache::Key key(others.chosen());
    if (const auto response = cache_.find(key)) return *response;
    const std::vector<SensorType>& kinds = basis_.problem.kinds;
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

/// Only moves that raise the rank count: no cycle is possible.
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
    // With more sensors than candidates, a sensor repeats a candidate.
    if (!response.is_found && !basis_.problem.is_connected) response = {{kind, 0}, 0, true};
    if (response.is_found) state.add(response.choice);
    return response.is_found;
}

void LocalSearch::fill(CoverageState& state) {
    while (add(state)) {
    }
}

/// Sells sensors and spends what they cost: tries one of each kind first, then adds the best.
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

/// Finds the positions of the sensors with the least loss per cost, ascending.
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

namespace {

constexpr std::size_t kChains = 4;
constexpr std::uint64_t kKicksPerRound = 12;     // of a chain in a round
constexpr std::size_t kMinOut = 2, kMaxOut = 4;  // sensors taken out by a kick
constexpr std::size_t kNeighbours = 5;           // from which the others are drawn
constexpr float kSlack = 0.002F;    // a chain may continue from a solution worse by this,
constexpr float kForgiving = 0.1F;  // one time in ten
/// The sequence of a kick differs from those of the starts' kicks.
constexpr std::uint64_t kFirstKey = 1ULL << 32U;

/// One chain of kicks.
class Chain {
  public:
    Chain(const SearchBasis& basis, ResponseCache& cache, std::uint64_t seed, std::uint64_t index,
          std::uint64_t enough, const Progress& progress)
        : problem_(basis.problem),
          search_(basis, cache, enough, progress),
          state_(basis.emptyState()),
          seed_(seed),
          index_(index),
          enough_(enough),
          progress_(progress) {}

    /// Returns the best of a round of kicks from a solution, or that solution.
    Solution run(const Solution& from) {
        Solution best = from, now = from;
        set(from.chosen);
        for (std::uint64_t i = 0;
             i < kKicksPerRound && best.value < enough_ && !progress_.stopped(); ++i) {
            std::array<float, kDraws> draws{};
            draw({seed_, Purpose::Placement, kFirstKey + index_, next_kick_++}, 0,
                 {.uniform = draws});
            kick(draws);
            search_.fill(state_);
            // The remaining sensors may fall into parts that no candidate joins.
            const bool is_whole = isFeasible(problem_, state_.chosen());
            if (is_whole) search_.improve(state_);
            const bool is_near = static_cast<double>(state_.value()) >=
                                 (1 - static_cast<double>(kSlack)) * static_cast<double>(now.value);
            if (is_whole &&
                (state_.value() >= now.value || (is_near && draws[kForgive] < kForgiving)))
                now = {state_.chosen(), state_.value()};
            else
                set(now.chosen);
            if (now.value > best.value) best = now;
        }
        return best;
    }

  private:
    /// Purposes of the random numbers of a kick.
    enum Draws : std::size_t {
        kForgive = 0,
        kPivot,
        kOut,
        kWhich,  ///< one for each removed with the pivot
        kPutIn = kWhich + kMaxOut - 1,
        kPlaces  ///< tries of an insertion
    };
    static constexpr std::size_t kTries = 24, kDraws = kPlaces + kTries;

    static std::size_t indexOf(float number, std::size_t size) {
        return std::min(static_cast<std::size_t>(number * static_cast<float>(size)), size - 1);
    }
    void set(const std::vector<Choice>& chosen) {
        state_.clear();
        for (const Choice& choice : chosen) state_.add(choice);
    }
    [[nodiscard]] std::uint32_t overlap(const Choice& choice, const WeightSums& seen) const {
        return problem_.kinds[choice.kind].candidates->weigh(choice.candidate, seen);
    }
    /// Removes a sensor and some with similar views; may insert one near them.
    void kick(const std::array<float, kDraws>& draws) {
        const Choice pivot = state_.chosen()[indexOf(draws[kPivot], state_.chosen().size())];
        std::vector<std::uint32_t> weights(problem_.cells(), 0);
        const CandidateSet& candidates = *problem_.kinds[pivot.kind].candidates;
        candidates.forEachRun(pivot.candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i) weights[i] = problem_.weights[i];
        });
        const WeightSums seen(weights);
        for (const Choice& choice : outOf(pivot, seen, draws)) {
            const std::vector<Choice>& chosen = state_.chosen();
            const auto at = std::find(chosen.begin(), chosen.end(), choice);
            state_.removeAt(static_cast<std::size_t>(at - chosen.begin()));
        }
        if (draws[kPutIn] >= 0.5F || problem_.is_connected) return;
        for (std::size_t i = 0; i < kTries; ++i) {
            const Choice place{pivot.kind, indexOf(draws[kPlaces + i], candidates.size())};
            if (overlap(place, seen) == 0) continue;
            state_.add(place);
            return;
        }
    }
    [[nodiscard]] std::vector<Choice> outOf(const Choice& pivot, const WeightSums& seen,
                                            const std::array<float, kDraws>& draws) const {
        std::vector<std::pair<std::uint32_t, std::size_t>> others;
        bool is_met = false;
        for (std::size_t i = 0; i < state_.chosen().size(); ++i) {
            const Choice& choice = state_.chosen()[i];
            if (choice == pivot && !std::exchange(is_met, true)) continue;
            others.emplace_back(overlap(choice, seen), i);
        }
        std::sort(others.begin(), others.end(), [](const auto& a, const auto& b) {
            return a.first != b.first ? a.first > b.first : a.second < b.second;
        });
        if (others.size() > kNeighbours) others.resize(kNeighbours);
        const std::size_t count = kMinOut + indexOf(draws[kOut], kMaxOut - kMinOut + 1);
        std::vector<Choice> out = {pivot};
        while (out.size() < count && !others.empty()) {
            const std::size_t which = indexOf(draws[kWhich + out.size() - 1], others.size());
            out.push_back(state_.chosen()[others[which].second]);
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(which));
        }
        return out;
    }

    const Problem& problem_;
    LocalSearch search_;
    CoverageState state_;
    std::uint64_t seed_, index_, enough_, next_kick_ = 0;
    const Progress& progress_;
};

}  // namespace

Solution iteratedLocalSearch(const Problem& problem, const Solution& start,
                             const KickOptions& options, Progress& progress) {
    if (start.chosen.size() < kMinOut || start.value >= options.enough) return start;
    progress.begin("improving", 0);
    SearchBasis basis(problem);
    basis.addBlocks();
    ResponseCache cache;
    std::vector<std::unique_ptr<Chain>> chains;
    chains.reserve(kChains);
    for (std::size_t i = 0; i < kChains; ++i)
        chains.push_back(
            std::make_unique<Chain>(basis, cache, options.seed, i, options.enough, progress));
    Solution best = start;
    int idle = 0;
    for (int round = 0; round < options.rounds && idle < options.patience; ++round) {
        if (best.value >= options.enough || progress.stopped()) break;
        std::vector<Solution> ends(kChains);
        tbb::parallel_for(std::size_t{0}, kChains,
                          [&](std::size_t i) { ends[i] = chains[i]->run(best); });
        ++idle;
        for (Solution& end : ends) {
            if (end.value <= best.value) continue;
            best = std::move(end);
            idle = 0;
        }
        progress.advance(1);
    }
    progress.end();
    return best;
}

}  // namespace ispace
