// SPDX-License-Identifier: GPL-3.0-or-later
// Local searches from many starts: the greedy solution, solutions of similar problems, and eight
// random sensors filled up greedily; the best ends are then kicked.
//
// Starts run in parallel and take each other's best responses from a cache. A start that reaches a
// sufficient value ends all later ones, and their results are dropped: what remains is the same for
// any number of threads. Random numbers are keyed by the number of the start.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <limits>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "arrange/search/local_search.h"
#include "arrange/search/packed_search.h"
#include "arrange/search/problem.h"
#include "arrange/search/search.h"
#include "base/random.h"

namespace ispace {

namespace {

/// Reports the best value so far.
class BestReporter {
  public:
    BestReporter(const Problem& problem, Progress& progress)
        : total_(std::max<std::uint64_t>(1, problem.totalWeight())), progress_(progress) {}
    void report(std::uint64_t value) {
        const std::lock_guard lock(mutex_);
        if (value <= best_) return;
        best_ = value;
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "best %.1f %%",
                      100.0 * static_cast<double>(value) / static_cast<double>(total_));
        progress_.note(text.data());
    }

  private:
    std::uint64_t total_, best_ = 0;
    Progress& progress_;
    std::mutex mutex_;
};

/// Draws candidates with probabilities in proportion to their gain alone.
class RandomCandidates {
  public:
    explicit RandomCandidates(const SearchBasis& basis) {
        sums_.reserve(basis.alone.size());
        for (const std::vector<std::uint32_t>& alone : basis.alone) {
            std::vector<double>& sums = sums_.emplace_back();
            sums.reserve(alone.size());
            double sum = 0;
            for (const std::uint32_t parts : alone) sums.push_back(sum += parts);
        }
    }
    /// Finds the candidate for a number in [0, 1).
    [[nodiscard]] std::size_t candidate(std::size_t kind, float where) const {
        const std::vector<double>& sums = sums_[kind];
        const auto found = std::upper_bound(sums.begin(), sums.end(), sums.back() * double{where});
        return std::min(static_cast<std::size_t>(found - sums.begin()), sums.size() - 1);
    }

  private:
    std::vector<std::vector<double>> sums_;  // per kind: cumulative gains of the candidates
};

/// Sensors of a start that are random; greedy placement adds the others.
constexpr std::size_t kRandomSensors = 8;
/// The best result of each so many starts is kicked: so often two of its sensors are removed, one
/// is inserted at random and one on its best candidate. Measured with 3 to 12 sensors: this halves
/// the loss of 20 starts, for as much time again.
constexpr std::size_t kStartsPerKicked = 5;
constexpr std::uint64_t kKicksPerStart = 10;
/// Maximum number of results that exchange pairs of sensors, if costs differ.
constexpr std::size_t kMaxBuyers = 6;
constexpr std::size_t kStartsPerBuyer = 4;

/// Maximum number of ends that are told.
constexpr std::size_t kMaxEnds = 6;

/// The result of a start.
struct End {
    std::size_t start = 0;
    std::uint64_t value = 0, parts = 0;
    double cost = std::numeric_limits<double>::infinity();
    std::vector<Choice> chosen;

    End() = default;
    End(std::size_t from, const CoverageState& state)
        : start(from),
          value(state.value()),
          parts(state.partialValue()),
          cost(state.problem().budget ? state.cost() : 0),
          chosen(state.chosen()) {}
    [[nodiscard]] bool isBetterThan(const End& other) const {
        return std::tuple(value, parts, -cost) > std::tuple(other.value, other.parts, -other.cost);
    }
};

/// Silent progress of the search from one start, which ends with the whole search and once an
/// earlier start has reached a sufficient value.
class StartProgress final : public Progress {
  public:
    StartProgress(const Progress& whole, const std::atomic<std::size_t>& first, std::size_t start)
        : whole_(whole), first_(first), start_(start) {}
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t /*count*/) override {}
    void end() override {}
    [[nodiscard]] bool stopped() const override { return first_ < start_ || whole_.stopped(); }

  private:
    const Progress& whole_;
    const std::atomic<std::size_t>& first_;
    std::size_t start_;
};

/// Stored results of starts, of earlier runs or other shards.
class KeptEnds {
  public:
    KeptEnds(const SearchShare* share, const Problem& problem, std::uint64_t enough,
             const std::vector<Choice>& given)
        : results_(share != nullptr ? share->results : nullptr), problem_(problem) {
        if (results_ == nullptr) return;
        name_ = results_->keyFor("start") + '/';
        mark_ = mixedBits(fingerprintOf(problem) ^ mixedBits(enough));
        for (const Choice& choice : given)
            mark_ = mixedBits(mark_ ^ mixedBits(choice.kind) ^ choice.candidate);
    }
    [[nodiscard]] std::optional<std::vector<Choice>> find(std::size_t start) const {
        const auto bytes =
            results_ == nullptr ? std::nullopt : results_->find(name_ + std::to_string(start));
        if (!bytes) return std::nullopt;
        Unpacker from(*bytes);
        if (from.number() != mark_) return std::nullopt;
        std::vector<Choice> chosen = unpackChoices(from, problem_);
        if (!from.atEnd() || !isFeasible(problem_, chosen)) return std::nullopt;
        return chosen;
    }
    void keep(std::size_t start, const std::vector<Choice>& chosen) {
        if (results_ == nullptr) return;
        Packer to;
        to.add(mark_);
        pack(to, chosen);
        results_->store(name_ + std::to_string(start), to.bytes());
    }

  private:
    JobResults* results_;
    const Problem& problem_;
    std::string name_;
    std::uint64_t mark_ = 0;
};

/// The searches from all starts.
class SwapSearch {
  public:
    SwapSearch(const Problem& problem, const SwapOptions& options, Progress& progress)
        : basis_(problem),
          places_(basis_),
          seed_(options.seed),
          enough_(options.enough),
          share_(options.share),
          more_(options.more),
          progress_(progress),
          reporter_(problem, progress) {
        basis_.addBlocks();
    }

    /// Searches from the given solution (start 0) and those of SwapOptions::more; if cells require
    /// several sensors, from a greedy solution by partial gains (the next start); and from random
    /// sensors. The results up to the first with a sufficient value are deterministic for any
    /// number of threads; later ones are empty.
    std::vector<End> searchFromAll(std::size_t starts, const std::vector<Choice>& given) {
        std::vector<End> ends(starts);
        const auto [begin, end] = ownOf(starts);
        KeptEnds kept(share_, basis_.problem, enough_, given);
        // Threads take starts in ascending order.
        std::atomic<std::size_t> next = begin, first = starts;
        tbb::parallel_for(begin, end, [&](std::size_t) {
            const std::size_t i = next++;
            if (i == 0 || (i < first && !progress_.stopped())) {
                StartProgress progress(progress_, first, i);
                if (const auto known = kept.find(i)) {
                    End known_end;
                    known_end.chosen = *known;
                    ends[i] = End(i, stateOf(known_end));
                } else {
                    ends[i] = searchFrom(i, given, progress);
                    if (!progress.stopped()) kept.keep(i, ends[i].chosen);
                }
                std::size_t before = first;
                while (ends[i].value >= enough_ && i < before &&
                       !first.compare_exchange_weak(before, i)) {
                }
            }
            progress_.advance(1);
        });
        for (std::size_t i = first + 1; i < starts; ++i) ends[i] = End();
        return ends;
    }

    /// Continues from a result by exchanging two sensors for others, if costs differ.
    End searchByPairs(const End& end) {
        CoverageState state = stateOf(end);
        LocalSearch(basis_, cache_, enough_, progress_).improveByPairs(state);
        reporter_.report(state.value());
        End next(end.start, state);
        return end.isBetterThan(next) ? end : next;
    }
    /// Continues from a result by random kicks.
    End searchAbout(const End& end) {
        CoverageState state = stateOf(end);
        LocalSearch search(basis_, cache_, enough_, progress_);
        End best = end;
        for (std::uint64_t kick = 1; kick <= kKicksPerStart && !isOver(best); ++kick) {
            const std::vector<Choice> before = state.chosen();
            kickOut(state, {seed_, Purpose::Placement, kick, end.start});
            search.fill(state);
            // The remaining sensors may fall into parts that no candidate joins.
            if (isFeasible(basis_.problem, state.chosen())) {
                search.improve(state);
                End next(end.start, state);
                if (!best.isBetterThan(next)) {
                    best = std::move(next);
                    continue;
                }
            }
            state.clear();
            for (const Choice& choice : before) state.add(choice);
        }
        reporter_.report(best.value);
        return best;
    }

    [[nodiscard]] bool isOver(const End& end) const {
        return end.value >= enough_ || progress_.stopped();
    }

    /// Returns true if other shards search from the rest of the starts.
    [[nodiscard]] bool isShard() const {
        return share_ != nullptr && share_->isOwn(Shared::Starts);
    }

  private:
    /// Returns the starts of this shard.
    [[nodiscard]] std::pair<std::size_t, std::size_t> ownOf(std::size_t starts) const {
        if (!isShard()) return {0, starts};
        const Shard::Block block = share_->own->blockOf(static_cast<std::int64_t>(starts));
        return {static_cast<std::size_t>(block.first), static_cast<std::size_t>(block.end)};
    }
    End searchFrom(std::size_t index, const std::vector<Choice>& given, Progress& progress) {
        CoverageState state = basis_.emptyState();
        LocalSearch search(basis_, cache_, enough_, progress);
        std::size_t start = index;
        if (start == 0) {
            for (const Choice& choice : given) state.add(choice);
        } else if (start <= more_.size()) {
            for (const Choice& choice : more_[start - 1]) state.add(choice);
        } else {
            start -= more_.size();
            // Greedy search prefers complete cells; starting from partial gains reaches other
            // solutions.
            if (start > 1 || !takesSteps(basis_.problem)) addRandomSensors(state, start);
            if (basis_.problem.required == 1)
                search.fill(state);
            else
                placeRest(basis_, false, state, progress);
        }
        search.improve(state);
        reporter_.report(state.value());
        return {index, state};
    }

    [[nodiscard]] CoverageState stateOf(const End& end) const {
        CoverageState state = basis_.emptyState();
        for (const Choice& choice : end.chosen) state.add(choice);
        return state;
    }

    /// Adds a random sensor of a random kind that may still be added, unless it would break a
    /// required connection. Both numbers are in [0, 1).
    void addRandom(CoverageState& state, float which, float where) const {
        std::vector<std::size_t> kinds;
        kinds.reserve(basis_.limits.size());
        for (std::size_t kind = 0; kind < basis_.limits.size(); ++kind)
            if (state.canTake(kind, basis_.limits[kind])) kinds.push_back(kind);
        if (kinds.empty()) return;
        const std::size_t kind = kinds[indexOf(which, kinds.size())];
        const Choice choice{kind, places_.candidate(kind, where)};
        const bool is_joined = !basis_.problem.is_connected ||
                               Connection(basis_.problem, state.chosen()).isJoinedBy(choice);
        if (is_joined) state.add(choice);
    }

    void addRandomSensors(CoverageState& state, std::size_t start) const {
        std::array<float, 2 * kRandomSensors> draws{};
        draw({seed_, Purpose::Placement, 0, start}, 0, {.uniform = draws});
        for (std::size_t i = 0; i < kRandomSensors; ++i)
            addRandom(state, draws[2 * i], draws[2 * i + 1]);
    }

    void kickOut(CoverageState& state, const RandomKey& key) const {
        std::array<float, 4> draws{};
        draw(key, 0, {.uniform = draws});
        for (std::size_t i = 0; i < 2 && !state.chosen().empty(); ++i)
            state.removeAt(indexOf(draws[i], state.chosen().size()));
        addRandom(state, draws[2], draws[3]);
    }

    static std::size_t indexOf(float number, std::size_t size) {
        return std::min(static_cast<std::size_t>(number * static_cast<float>(size)), size - 1);
    }

    SearchBasis basis_;
    RandomCandidates places_;
    std::uint64_t seed_, enough_;
    const SearchShare* share_;
    const std::vector<std::vector<Choice>>& more_;
    Progress& progress_;
    BestReporter reporter_;
    ResponseCache cache_;
};

/// Returns the best results, without duplicate sets of choices.
std::vector<End> bestOf(std::vector<End> ends, std::size_t count) {
    std::stable_sort(ends.begin(), ends.end(),
                     [](const End& a, const End& b) { return a.isBetterThan(b); });
    std::vector<End> best;
    std::set<std::vector<Choice>> seen;
    for (End& end : ends) {
        std::vector<Choice> chosen = end.chosen;
        std::sort(chosen.begin(), chosen.end());
        if (best.size() < count && seen.insert(std::move(chosen)).second)
            best.push_back(std::move(end));
    }
    return best;
}

/// Sorts the choices by the order of kinds that the problem requires.
std::vector<Choice> inOrder(const Problem& problem, std::vector<Choice> chosen) {
    std::vector<Choice> ordered;
    ordered.reserve(chosen.size());
    for (const std::size_t kind : problem.order) {
        const auto found = std::find_if(chosen.begin(), chosen.end(), [kind](const Choice& choice) {
            return choice.kind == kind;
        });
        if (found == chosen.end()) continue;
        ordered.push_back(*found);
        chosen.erase(found);
    }
    ordered.insert(ordered.end(), chosen.begin(), chosen.end());
    return ordered;
}

}  // namespace

Solution improveBySwaps(const Problem& problem, const Solution& start, const SwapOptions& options,
                        Progress& progress) {
    if (start.value >= options.enough) return start;
    const auto starts = static_cast<std::size_t>(std::max(0, options.starts));
    const std::size_t given = 1 + options.more.size();
    const std::size_t kicked = (starts + kStartsPerKicked - 1) / kStartsPerKicked;
    const std::size_t buyers =
        problem.budget ? std::min(1 + starts / kStartsPerBuyer, kMaxBuyers) : 0;
    progress.begin("improving", static_cast<std::int64_t>(given + starts + buyers + kicked));
    SwapSearch search(problem, options, progress);
    std::vector<End> ends = search.searchFromAll(given + starts, start.chosen);
    if (search.isShard()) {
        progress.end();
        return start;
    }
    End best = bestOf(ends, 1).front();
    // Continues from the best results so far.
    const auto go_on = [&](std::size_t count, End (SwapSearch::*how)(const End&)) {
        if (count > 0 && best.chosen.size() > 1 && !search.isOver(best)) {
            std::vector<End> more = bestOf(ends, count);
            tbb::parallel_for(std::size_t{0}, more.size(),
                              [&](std::size_t i) { more[i] = (search.*how)(more[i]); });
            ends.insert(ends.end(), more.begin(), more.end());
            best = bestOf(ends, 1).front();
        }
        progress.advance(static_cast<std::int64_t>(count));
    };
    go_on(buyers, &SwapSearch::searchByPairs);
    go_on(kicked, &SwapSearch::searchAbout);
    if (options.ends != nullptr) {
        options.ends->clear();
        for (End& end : bestOf(ends, kMaxEnds))
            if (!end.chosen.empty()) options.ends->push_back(std::move(end.chosen));
    }
    progress.end();
    return {inOrder(problem, std::move(best.chosen)), best.value};
}

}  // namespace ispace
