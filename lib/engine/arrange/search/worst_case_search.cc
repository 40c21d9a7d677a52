// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "arrange/search/case_values.h"
#include "arrange/search/worst_case.h"

namespace ispace {

namespace {

using Gains = std::vector<std::uint32_t>;

/// A weighted mean of the cases: a problem whose bound holds for the worst case, too.
struct MeanOfCases {
    Problem problem;
    /// The worst case, in units of the first block, is at most value * unit / per.
    std::uint64_t unit = 1, per = 1;

    [[nodiscard]] std::uint64_t bound(std::uint64_t value) const {
        constexpr double kSafe = 9e18;
        const double product = static_cast<double>(value) * static_cast<double>(unit);
        // Rounding up keeps it a bound.
        if (product > kSafe)
            return static_cast<std::uint64_t>(product / static_cast<double>(per) * (1 + 1e-12)) + 1;
        return value * unit / per;
    }
};

/// Searches moves of single sensors by the worst cases.
class CaseMoves {
  public:
    CaseMoves(const WorstCaseProblem& of, const Progress& progress)
        : of_(of), progress_(progress) {}

    /// Moves sensors while the worst case gains.
    void improve(Solution& solution) const {
        for (bool moves = true; moves;) {
            moves = false;
            for (std::size_t i = 0; i < solution.chosen.size() && !progress_.stopped(); ++i)
                moves |= move(solution, i);
        }
    }

  private:
    /// Moves a sensor to the candidate with the best worst case; returns false if none gains.
    /// Starts with the worst case of the others, and adds the worst case of each candidate that
    /// fails by one not considered yet: the first that passes all cases considered and is as good
    /// as they say is the best.
    bool move(Solution& solution, std::size_t position) const {
        constexpr int kMaxCases = 12;
        std::vector<Choice> others = solution.chosen;
        const std::size_t kind = others[position].kind;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(position));
        const CaseValues values(of_, others);
        std::uint64_t cap = std::numeric_limits<std::uint64_t>::max();
        if (of_.failures > 0)
            cap = values.worstOf(static_cast<std::size_t>(of_.failures) - 1).value;
        if (cap <= solution.value) return false;
        const CandidateSet& set = *of_.problem->kinds[kind].candidates;
        std::vector<std::uint64_t> least(set.size(), cap);
        for (const Choice& other : others)
            if (other.kind == kind) least[other.candidate] = 0;
        CaseValue next = values.worst();
        for (int round = 0; round < kMaxCases; ++round) {
            add(values, next, set, kind, least);
            const auto best = std::max_element(least.begin(), least.end());
            if (*best <= solution.value) return false;
            std::vector<Choice> moved = solution.chosen;
            moved[position].candidate = static_cast<std::size_t>(best - least.begin());
            CaseValue worst = worstCase(of_, moved);
            if (worst.value > solution.value) {
                solution = {std::move(moved), worst.value};
                return true;
            }
            // The moved sensor is not among those that fail: such cases are in the cap.
            for (std::size_t& failed : worst.failed)
                if (failed > of_.standing.size() + position) --failed;
            next = std::move(worst);
        }
        return false;
    }

    /// Lowers `least` to the value of each candidate in this case of the others.
    void add(const CaseValues& values, const CaseValue& in, const CandidateSet& set,
             std::size_t kind, std::vector<std::uint64_t>& least) const {
        Gains gains;
        values.gains(in, kind, gains);
        std::vector<std::uint32_t> added(set.size());
        set.weighAll(WeightSums(gains), added);
        const std::uint64_t before = values.valueIn(in);
        for (std::size_t i = 0; i < added.size(); ++i)
            least[i] = std::min(least[i], values.scaled(in.block, before + added[i]));
    }

    const WorstCaseProblem& of_;
    const Progress& progress_;
};

/// One search.
class WorstCaseSearch {
  public:
    WorstCaseSearch(const WorstCaseProblem& of, const SearchOptions& options, Progress& progress)
        : of_(of), options_(options), progress_(progress), moves_(of, progress) {
        options_.share = SearchShare();
        is_exact_ = options_.optimizer == Optimizer::Exact;
        if (is_exact_) options_.optimizer = Optimizer::Swap;  // of the means
        result_.bound = of.totalOf(0);
        result_.best.value = worstCase(of, {}).value;
    }

    SearchResult run() {
        if (of_.failures > 0) {
            take({*of_.problem, of_.totalOf(0), of_.least_total});
            if (!isClosed()) takeFewer();
        } else if (of_.ways != nullptr) {
            takePaths();
        } else {
            takeMeans();
        }
        if (is_exact_ && !isClosed()) branch();
        fill(result_.best.chosen);
        result_.is_complete = !progress_.stopped() || result_.best.value >= result_.bound;
        return std::move(result_);
    }

  private:
    [[nodiscard]] bool isClosed() const {
        const auto open = static_cast<double>(result_.bound - result_.best.value);
        return open <= options_.gap * static_cast<double>(result_.bound);
    }

    /// Searches for the best mean, which bounds the worst case; its layout is a start.
    std::vector<Choice> take(MeanOfCases mean) {
        const SearchResult found = search(mean.problem, options_, progress_);
        result_.bound = std::min(result_.bound, mean.bound(found.bound));
        start(found.best.chosen);
        means_.push_back(std::move(mean));
        return found.best.chosen;
    }

    void start(const std::vector<Choice>& chosen) {
        Solution solution{chosen, 0};
        std::sort(solution.chosen.begin(), solution.chosen.end());
        solution.chosen.erase(std::unique(solution.chosen.begin(), solution.chosen.end()),
                              solution.chosen.end());
        solution.value = worstCase(of_, solution.chosen).value;
        if (options_.optimizer != Optimizer::Greedy) moves_.improve(solution);
        if (solution.value > result_.best.value || result_.best.chosen.empty())
            result_.best = std::move(solution);
    }

    /// The failure of any K of the placed sensors leaves a layout of so many less.
    void takeFewer() {
        std::size_t placed = 0;
        for (const SensorType& kind : of_.problem->kinds)
            placed += static_cast<std::size_t>(kind.most);
        const auto failures = static_cast<std::size_t>(of_.failures);
        if (placed <= failures) {
            result_.bound =
                std::min(result_.bound, CaseValues(of_, std::vector<Choice>()).ofBlocks().front());
            return;
        }
        Problem fewer = *of_.problem;
        std::fill(fewer.weights.begin() + static_cast<std::ptrdiff_t>(of_.blocks[0].end),
                  fewer.weights.end(), 0U);
        for (SensorType& kind : fewer.kinds) kind.cost = 1;
        fewer.budget = static_cast<double>(placed - failures);
        fewer.order.clear();
        result_.bound = std::min(result_.bound, search(fewer, options_, progress_).bound);
    }

    /// Plays the cases against the layouts.
    void takeMeans() {
        const int rounds = options_.optimizer == Optimizer::Greedy ? 2 : is_exact_ ? 16 : 8;
        const std::size_t cases = of_.blocks.size();
        const double pace = std::sqrt(8 * std::log(static_cast<double>(cases) + 1) / rounds);
        std::vector<double> sums(cases);  // of values, each round from 0 to 1
        for (int round = 0; round < rounds; ++round) {
            if (round > 0 && (progress_.stopped() || isClosed() || cases == 1)) return;
            const auto mean = meanBy(sums, pace);
            if (!mean) return;
            const std::vector<Choice> chosen = take(*mean);
            const std::vector<std::uint64_t> values = CaseValues(of_, chosen).ofBlocks();
            const auto [least, most] = std::minmax_element(values.begin(), values.end());
            const auto spread = static_cast<double>(std::max<std::uint64_t>(*most - *least, 1));
            for (std::size_t b = 0; b < cases; ++b)
                sums[b] += static_cast<double>(values[b] - *least) / spread;
            if (round == 0) options_.swap.starts = (options_.swap.starts + 3) / 4;
        }
    }

    /// Plays ways against the layouts.
    void takePaths() {
        const int rounds = options_.optimizer == Optimizer::Greedy ? 4 : is_exact_ ? 24 : 12;
        std::vector<CellPath> ways = waysApart();
        for (int round = 0; round < rounds; ++round) {
            if (round > 0 && (progress_.stopped() || isClosed())) return;
            const auto mean = meanOf(ways);
            if (!mean) return;
            for (const std::vector<Choice>& chosen : {take(*mean), result_.best.chosen}) {
                CaseValue worst = worstCase(of_, chosen);
                ways.push_back({worst.value, 0, std::move(worst.way)});
            }
            if (round == 0) options_.swap.starts = (options_.swap.starts + 3) / 4;
        }
    }

    /// Finds ways that avoid the cells of those before as far as they can.
    [[nodiscard]] std::vector<CellPath> waysApart() const {
        constexpr std::size_t kMaxPaths = 16;
        std::vector<CellPath> ways;
        CellSet taken(of_.problem->cells());
        while (ways.size() < kMaxPaths) {
            ways.push_back(
                of_.ways->leastSeen([&taken](std::uint32_t cell) { return taken.test(cell); }));
            if (ways.size() > 1 && 2 * ways.back().seen > of_.shortest) break;
            for (const PathCell& piece : ways.back().cells) taken.set(piece.cell);
        }
        return ways;
    }

    /// Returns the problem of the mean seen length of these ways; empty if weights leave no room.
    [[nodiscard]] std::optional<MeanOfCases> meanOf(const std::vector<CellPath>& ways) const {
        constexpr std::uint64_t kMaxTotal = 0xffffffffU;
        MeanOfCases mean{*of_.problem, 1, ways.size()};
        std::fill(mean.problem.weights.begin(), mean.problem.weights.end(), 0U);
        std::uint64_t total = 0;
        for (const CellPath& way : ways)
            for (const PathCell& piece : way.cells) total += piece.length;
        if (total > kMaxTotal) return std::nullopt;
        for (const CellPath& way : ways)
            for (const PathCell& piece : way.cells)
                mean.problem.weights[piece.cell] += piece.length;
        return mean;
    }

    /// Weighs the cases by whole numbers: the problem's bound is exact, then. Empty if weights
    /// leave no room for it.
    [[nodiscard]] std::optional<MeanOfCases> meanBy(const std::vector<double>& sums,
                                                    double pace) const {
        constexpr double kMaxScale = 1000, kSum = 4e9;
        const double least = *std::min_element(sums.begin(), sums.end());
        std::vector<double> weights;
        double sum = 0, highest = 0;
        for (std::size_t b = 0; b < sums.size(); ++b) {
            const auto total = static_cast<double>(std::max<std::uint64_t>(of_.totalOf(b), 1));
            const double share = std::exp(-pace * (sums[b] - least));
            weights.push_back(share / total);
            sum += share;
            highest = std::max(highest, share / total);
        }
        const bool is_even = std::all_of(weights.begin(), weights.end(),
                                         [&](double weight) { return weight == weights[0]; });
        const double scale = is_even ? 1 / highest : std::min(kMaxScale / highest, kSum / sum);
        if (scale * highest < 1 && !is_even) return std::nullopt;
        MeanOfCases mean{*of_.problem, of_.totalOf(0), 0};
        for (std::size_t b = 0; b < sums.size(); ++b) {
            const auto times = static_cast<std::uint32_t>(std::floor(scale * weights[b] + 1e-9));
            mean.per += times * of_.totalOf(b);
            for (std::size_t i = of_.blocks[b].first; i < of_.blocks[b].end; ++i)
                mean.problem.weights[i] *= times;
        }
        if (mean.per == 0) return std::nullopt;
        return mean;
    }

    /// Adds the sensors that the worst case does not need; none of them lowers it.
    void fill(std::vector<Choice>& chosen) const {
        for (std::size_t k = 0; k < of_.problem->kinds.size(); ++k) {
            const std::size_t size = of_.problem->kinds[k].candidates->size();
            std::size_t missing = left(chosen, k);
            for (std::size_t i = 0; i < size && missing > 0; ++i) {
                const Choice choice{k, i};
                if (std::find(chosen.begin(), chosen.end(), choice) != chosen.end()) continue;
                chosen.push_back(choice);
                --missing;
            }
        }
    }

    // ---- The tree of Exact

    /// Extends `chosen` by sensors of the kinds in turn, each on a candidate after those before.
    void branch() {
        std::vector<Choice> chosen;
        extend(chosen, 0, 0);
        if (!progress_.stopped()) result_.bound = result_.best.value;
    }

    void extend(std::vector<Choice>& chosen, std::size_t kind, std::size_t first) {
        if (progress_.stopped()) return;
        const std::uint64_t value = worstCase(of_, chosen).value;
        if (value > result_.best.value) result_.best = {chosen, value};
        for (std::size_t k = kind; k < of_.problem->kinds.size(); ++k) {
            const std::size_t begin = k == kind ? first : 0;
            if (boundFrom(chosen, k, begin) <= result_.best.value) return;
            const CandidateSet& set = *of_.problem->kinds[k].candidates;
            if (left(chosen, k) == 0) continue;
            for (std::size_t i = begin; i < set.size(); ++i) {
                chosen.push_back({k, i});
                extend(chosen, k, i + 1);
                chosen.pop_back();
            }
        }
    }

    [[nodiscard]] std::size_t left(const std::vector<Choice>& chosen, std::size_t kind) const {
        const auto taken = std::count_if(chosen.begin(), chosen.end(),
                                         [&](const Choice& c) { return c.kind == kind; });
        return static_cast<std::size_t>(
            std::max<std::ptrdiff_t>(0, of_.problem->kinds[kind].most - taken));
    }

    /// Bounds the layouts that add candidates of this kind from `first` on, and of later kinds. A
    /// cell that lacks several sensors gains its weight over that number by each.
    [[nodiscard]] std::uint64_t boundFrom(const std::vector<Choice>& chosen, std::size_t kind,
                                          std::size_t first) const {
        std::uint64_t least = result_.bound;
        for (const MeanOfCases& mean : means_)
            least = std::min(least, mean.bound(boundFrom(mean.problem, chosen, kind, first)));
        return least;
    }

    [[nodiscard]] std::uint64_t boundFrom(const Problem& problem, const std::vector<Choice>& chosen,
                                          std::size_t kind, std::size_t first) const {
        std::vector<int> counts(problem.achieved.begin(), problem.achieved.end());
        counts.resize(problem.cells());
        for (const Choice& choice : chosen)
            problem.kinds[choice.kind].candidates->forEachRun(
                choice.candidate, [&](const CellRun& run) {
                    for (std::uint32_t i = run.first; i < run.end; ++i)
                        counts[i] += problem.kinds[choice.kind].multiplicity;
                });
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < counts.size(); ++i)
            if (counts[i] >= problem.required) value += problem.weights[i];
        for (std::size_t k = kind; k < problem.kinds.size(); ++k)
            value += gainFrom(problem, counts, k, k == kind ? first : 0, left(chosen, k));
        return value;
    }

    /// Returns the sum of the largest gains of so many candidates.
    [[nodiscard]] static std::uint64_t gainFrom(const Problem& problem,
                                                const std::vector<int>& counts, std::size_t kind,
                                                std::size_t first, std::size_t number) {
        const int added = problem.kinds[kind].multiplicity;
        Gains gains(problem.cells());
        for (std::size_t i = 0; i < gains.size(); ++i)
            if (const int lacks = problem.required - counts[i]; lacks > 0) {
                const auto all = static_cast<std::uint64_t>(lacks);
                const auto own = static_cast<std::uint64_t>(std::min(added, lacks));
                gains[i] = static_cast<std::uint32_t>((problem.weights[i] * own + all - 1) / all);
            }
        const CandidateSet& set = *problem.kinds[kind].candidates;
        std::vector<std::uint32_t> values(set.size());
        set.weighAll(WeightSums(gains), values);
        values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first));
        number = std::min(number, values.size());
        std::partial_sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(number),
                          values.end(), std::greater<>());
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < number; ++i) sum += values[i];
        return sum;
    }

    const WorstCaseProblem& of_;
    SearchOptions options_;
    Progress& progress_;
    CaseMoves moves_;
    bool is_exact_ = false;
    std::vector<MeanOfCases> means_;
    SearchResult result_;
};

}  // namespace

SearchResult searchWorstCase(const WorstCaseProblem& of, const SearchOptions& options,
                             Progress& progress) {
    return WorstCaseSearch(of, options, progress).run();
}

}  // namespace ispace
