// SPDX-License-Identifier: GPL-3.0-or-later
// The stages of a search: greedy placement, a quick bound, swaps, a tight bound; for Exact also
// kicks, the overlap bound and the tree.
//
// Invariant: the best value only rises, the bound only falls, and both are valid after each stage,
// so that a search may stop at any of them. From the swaps on, a stage whose result is stored under
// its name, with the fingerprint of the problem, is read instead of computed: shards and later runs
// take the same course.
#include "arrange/search/search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "arrange/search/branch_and_bound.h"
#include "arrange/search/local_search.h"
#include "arrange/search/packed_search.h"
#include "arrange/search/pair_bound.h"
#include "arrange/search/relaxation.h"

namespace ispace {

namespace {

// Limits of a quick bound and of a tight one.
constexpr LagrangeLimits kQuick = {.gap = 0.01, .rounds = 8};
constexpr double kSmallGap = 0.001;
// A tree takes too long to close a wider gap than this.
constexpr double kWideGap = 0.005;
/// With at least this many sensors, the overlap bound and kicks close more of the gap than a tree
/// does in the same time.
constexpr std::size_t kManySensors = 6;
/// Before the overlap bound, which also gains from a better solution.
constexpr KickOptions kFewKicks = {.rounds = 1};
constexpr int kOverlapRounds = 60;
/// A tree over so few sets of sensors takes less time than swaps from many starts.
constexpr double kFewSets = 3e5;
constexpr double kOverlapStall = 0.04;
/// Share of the random starts that a search from solutions of similar problems takes.
constexpr double kFewerStarts = 0.4;

LagrangeLimits limitsOf(const SearchOptions& options) {
    LagrangeLimits limits;
    switch (options.optimizer) {
        case Optimizer::Greedy:
            limits = kQuick;
            limits.gap = std::max(limits.gap, options.gap);
            break;
        case Optimizer::Swap:
            limits.gap = std::max(kSmallGap, options.gap);
            break;
        case Optimizer::Exact:
            // The tree begins from these multipliers, and each of its nodes costs more than a
            // round.
            limits = {.gap = options.gap, .rounds = 40, .stall = 0.0125, .pace = kLongPace};
            break;
    }
    return limits;
}

/// Returns the value at which the search ends.
std::uint64_t enoughOf(const Problem& problem, std::uint64_t bound, double gap) {
    // Swaps also look for cheaper solutions of the same value.
    if (problem.budget && gap <= 0) return std::numeric_limits<std::uint64_t>::max();
    return bound -
           static_cast<std::uint64_t>(std::clamp(gap, 0.0, 1.0) * static_cast<double>(bound));
}

/// Returns true if the survivors of a bound form few sets of so many sensors.
bool areFew(const Bound& bound, std::size_t sensors) {
    double survivors = 0, sets = 1;
    for (const auto& kind : bound.survivors) survivors += static_cast<double>(kind.size());
    for (std::size_t n = 0; n < sensors; ++n)
        sets *= std::max(1.0, survivors - static_cast<double>(n)) / static_cast<double>(n + 1);
    return sets <= kFewSets;
}

}  // namespace

std::string_view nameOf(Optimizer optimizer) {
    switch (optimizer) {
        case Optimizer::Greedy:
            return "greedy";
        case Optimizer::Swap:
            return "swap";
        case Optimizer::Exact:
            break;
    }
    return "exact";
}

Solution placeFeasibly(const Problem& problem, Progress& progress) {
    Solution solution = placeGreedily(problem, progress);
    if (!isFeasible(problem, solution.chosen)) solution = {{}, valueOf(problem, {})};
    return solution;
}

namespace {

/// Returns the job's result under this name for this very problem, else the result of `compute`,
/// which is stored unless it was cut short.
template <typename T, typename Compute>
T recalled(const SearchShare& share, const Problem& problem, const std::string& step,
           T (*unpack)(Unpacker&, const Problem&), const Progress& progress, Compute compute) {
    if (share.results == nullptr) return compute();
    const std::string name = share.results->keyFor(step);
    const std::uint64_t mark = fingerprintOf(problem);
    if (const auto bytes = share.results->find(name)) {
        Unpacker from(*bytes);
        if (from.number() == mark) return unpack(from, problem);
    }
    T made = compute();
    if (progress.stopped()) return made;
    Packer to;
    to.add(mark);
    pack(to, made);
    share.results->store(name, to.bytes());
    return made;
}

std::string proofName(const SearchShare& share, int shard) {
    return "proof/" + std::to_string(shard) + share.search;
}

/// Merges the shards' proofs: the best of their subtrees, and the highest of their bounds. Without
/// that of a shard, which was cut short before this one of several searches, the bound is that of
/// all sensors.
SearchResult joinedProof(const Problem& problem, const SearchShare& share) {
    SearchResult all;
    all.best.value = valueOf(problem, {});
    for (int i = 1; i <= share.joined; ++i) {
        const auto bytes = share.results->find(proofName(share, i));
        if (!bytes && share.search.empty()) Unpacker::refuse();
        if (!bytes) {
            all.bound = problem.totalWeight();
            all.is_complete = false;
            continue;
        }
        Unpacker from(*bytes);
        if (from.number() != fingerprintOf(problem)) Unpacker::refuse();
        SearchResult own = unpackResult(from, problem);
        if (all.best.chosen.empty() || own.best.value > all.best.value)
            all.best = std::move(own.best);
        all.bound = std::max(all.bound, own.bound);
        all.is_complete = all.is_complete && own.is_complete;
    }
    if (all.best.value >= all.bound) all.is_complete = true;
    return all;
}

/// One search, step by step.
class Search {
  public:
    Search(const Problem& problem, const SearchOptions& options, Progress& progress)
        : problem_(problem), options_(options), share_(options.share), progress_(progress) {}

    SearchResult run() {
        result_.bound = problem_.totalWeight();
        result_.best = placeFeasibly(problem_, progress_);
        noteProgress(problem_, result_, progress_);
        if (options_.optimizer != Optimizer::Greedy && !progress_.stopped()) swap();
        if (share_.isOwn(Shared::Starts)) return std::move(result_);
        if (!progress_.stopped() && result_.best.value < result_.bound) prove();
        if (result_.bound == problem_.totalWeight() && progress_.stopped()) {
            SilentProgress silent;  // a bound is always required
            const LagrangeLimits soon = {.cut = result_.best.value, .gap = kQuick.gap, .rounds = 2};
            result_.bound = lagrangianBound(problem_, result_.best.chosen, soon, silent).value;
        }
        if (progress_.stopped() && result_.best.value < result_.bound) result_.is_complete = false;
        return std::move(result_);
    }

  private:
    [[nodiscard]] Bound boundWithin(LagrangeLimits limits) {
        if (options_.similar != nullptr) limits.start = &options_.similar->multipliers;
        Bound bound = lagrangianBound(problem_, result_.best.chosen, limits, progress_);
        if (options_.similar != nullptr) options_.similar->multipliers = bound.multipliers;
        return bound;
    }
    void swap() {
        const bool is_few = result_.best.chosen.size() < kManySensors && !problem_.budget;
        if (is_few)
            result_.best = improveBySwaps(problem_, result_.best,
                                          {.starts = 0, .enough = options_.swap.enough}, progress_);
        // Swaps may take long: if time runs out, this is the bound.
        LagrangeLimits quick = kQuick;
        quick.cut = result_.best.value;
        quick.gap = std::min(quick.gap, limitsOf(options_).gap);
        const Bound bound = boundWithin(quick);
        result_.bound = bound.value;
        noteProgress(problem_, result_, progress_);
        if (is_few && areFew(bound, result_.best.chosen.size())) return branch(bound);
        result_ = recalled(share_, problem_, "swapped", unpackResult, progress_, [&] {
            SearchResult better = result_;
            SwapOptions swap = options_.swap;
            swap.enough = std::min(swap.enough, enoughOf(problem_, result_.bound, options_.gap));
            swap.share = &share_;
            if (options_.similar != nullptr && !options_.similar->starts.empty()) {
                swap.more = options_.similar->starts;
                swap.starts = static_cast<int>(std::ceil(kFewerStarts * swap.starts));
            }
            if (options_.similar != nullptr) swap.ends = &options_.similar->starts;
            better.best = improveBySwaps(problem_, result_.best, swap, progress_);
            return better;
        });
    }
    void prove() {
        LagrangeLimits limits = limitsOf(options_);
        limits.cut = result_.best.value;
        const Bound bound = recalled(share_, problem_, "bound", unpackBound, progress_,
                                     [&] { return boundWithin(limits); });
        if (options_.similar != nullptr) options_.similar->multipliers = bound.multipliers;
        if (bound.value < result_.best.value) Unpacker::refuse();  // a kept bound is wrong
        result_.bound = std::min(result_.bound, bound.value);
        noteProgress(problem_, result_, progress_);
        if (options_.optimizer != Optimizer::Exact) return;
        kick(kFewKicks);
        if (result_.best.chosen.size() >= kManySensors) {
            boundByOverlaps(bound);
            kick(KickOptions());
        }
        branch(bound);
    }
    void branch(const Bound& bound) {
        if (progress_.stopped() || result_.best.value >= result_.bound) return;
        result_ =
            branchAndBound(problem_, bound, std::move(result_), options_.gap, progress_,
                           std::numeric_limits<std::uint64_t>::max(), options_.max_bytes, share_);
    }
    /// Returns true if a tree cannot close the gap in reasonable time.
    [[nodiscard]] bool isWide() const {
        const auto open = static_cast<double>(result_.bound - result_.best.value);
        return open > std::max(options_.gap, kWideGap) * static_cast<double>(result_.bound);
    }
    /// A wide gap may be due to the solution rather than to the bound.
    void kick(KickOptions options) {
        if (!isWide() || progress_.stopped()) return;
        options.seed = options_.swap.seed;
        options.enough = enoughOf(problem_, result_.bound, options_.gap);
        result_ = recalled(share_, problem_, "kicked", unpackResult, progress_, [&] {
            SearchResult better = result_;
            better.best = iteratedLocalSearch(problem_, result_.best, options, progress_);
            return better;
        });
        noteProgress(problem_, result_, progress_);
    }
    void boundByOverlaps(const Bound& plain) {
        if (!isWide()) return;
        const LagrangeLimits limits = {.cut = result_.best.value,
                                       .gap = options_.gap,
                                       .rounds = kOverlapRounds,
                                       .stall = kOverlapStall,
                                       .pace = kLongPace};
        result_ = recalled(share_, problem_, "overlaps", unpackResult, progress_, [&] {
            SearchResult tighter = result_;
            tighter.bound =
                std::min(tighter.bound,
                         overlapBound(problem_, plain, tighter.best.chosen, limits, progress_));
            return tighter;
        });
        noteProgress(problem_, result_, progress_);
    }

    const Problem& problem_;
    const SearchOptions& options_;
    const SearchShare& share_;
    Progress& progress_;
    SearchResult result_;
};

}  // namespace

std::string_view nameOf(Shared shared) {
    switch (shared) {
        case Shared::Candidates:
            return "candidates";
        case Shared::Starts:
            return "starts";
        case Shared::Poses:
            return "poses";
        case Shared::Tree:
            break;
    }
    return "tree";
}

SearchResult search(const Problem& problem, const SearchOptions& options, Progress& progress) {
    const SearchShare& share = options.share;
    if (share.joined > 0 && share.what == Shared::Tree) return joinedProof(problem, share);
    SearchResult result = Search(problem, options, progress).run();
    if (share.isOwn(Shared::Tree)) {
        Packer to;
        to.add(fingerprintOf(problem));
        pack(to, result);
        share.results->store(proofName(share, share.own->index), to.bytes());
    }
    return result;
}

void noteProgress(const Problem& problem, std::uint64_t value, std::uint64_t bound,
                  Progress& progress) {
    const double total = static_cast<double>(std::max<std::uint64_t>(problem.totalWeight(), 1));
    char text[80];
    const int length = std::snprintf(text, sizeof text, "best %.1f %%, at most %.1f %%",
                                     100 * static_cast<double>(value) / total,
                                     100 * static_cast<double>(bound) / total);
    progress.note({text, static_cast<std::size_t>(length)});
}

}  // namespace ispace
