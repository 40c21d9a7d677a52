// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/kick_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "base/random.h"
#include "solve/local_search.h"

namespace ispace {

namespace {

constexpr std::size_t kChains = 4;
constexpr std::uint64_t kKicks = 12;                // of a chain in a round
constexpr std::size_t kLeastOut = 2, kMostOut = 4;  // sensors taken out by a kick
constexpr std::size_t kNeighbours = 5;              // of which the others are drawn
constexpr float kSlack = 0.002F;                    // a chain may go on from what is so much worse,
constexpr float kForgiving = 0.1F;                  // one time in ten
/// The sequence of a kick does not meet those of the starts' kicks.
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

    /// The best of a round of kicks from a solution, or that.
    Solution run(const Solution& from) {
        Solution best = from, now = from;
        set(from.chosen);
        for (std::uint64_t i = 0; i < kKicks && best.value < enough_ && !progress_.stopped(); ++i) {
            std::array<float, kDraws> draws{};
            draw({seed_, Purpose::Placement, kFirstKey + index_, next_kick_++}, 0,
                 {.uniform = draws});
            kick(draws);
            search_.fill(state_);
            // What remains may fall into parts that no candidate joins.
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
    /// What the random numbers of a kick decide.
    enum Draws : std::size_t {
        kForgive = 0,
        kPivot,
        kOut,
        kWhich,  ///< one for each that goes with the pivot
        kPutIn = kWhich + kMostOut - 1,
        kPlaces  ///< tries of a place
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
    /// Takes out a sensor and some that see most of the same; maybe puts one in thereabouts.
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
        const std::size_t count = kLeastOut + indexOf(draws[kOut], kMostOut - kLeastOut + 1);
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

Solution improveByKicks(const Problem& problem, const Solution& start, const KickOptions& options,
                        Progress& progress) {
    if (start.chosen.size() < kLeastOut || start.value >= options.enough) return start;
    progress.begin("improving", 0);
    const SearchBasis basis(problem);
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
