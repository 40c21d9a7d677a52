// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of bounds and searches: random problems, and their solution by brute force.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arrange/search/problem.h"
#include "base/error.h"

namespace ispace {

/// Parameters of a random problem. Ranges are closed.
struct RandomProblemOptions {
    int columns = 12, rows = 10;  ///< of the grid
    int kinds = 1;
    int sites = 6;         ///< of each kind
    int headings = 4;      ///< of each site with parts; every third site has a plain CellSet
    int most = 3;          ///< of each kind
    int max_range = 5;     ///< in cells; at least 2
    int max_weight = 1;    ///< weights are 0 (rarely) to this
    int max_achieved = 0;  ///< multiplicity from standing sensors
    int required = 1;
    std::vector<int> multiplicities;  ///< per kind; empty: all 1
    bool has_costs = false;  ///< 1, 1.5, 2, ... by kind, and a budget for about half of all
    bool has_order = false;  ///< a shuffled order of all sensors
    bool is_connected = false;
    bool has_standing =
        false;  ///< some cells are seen already (and achieved where max_achieved is above 0)
};

/// A problem with the candidates that it points to.
struct RandomProblem {
    std::vector<std::unique_ptr<CandidateSet>> candidates;
    Problem problem;
};

namespace test_problems {

using Random = std::mt19937_64;

/// Draws uniformly from [low, high]. The standard library's results differ between machines.
inline int anyOf(Random& random, int low, int high) {
    return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
}

/// A star: cells around a centre, by direction, each direction with a separate reach, as walls
/// leave it.
class Star {
  public:
    Star(Random& random, const RandomProblemOptions& options, int directions)
        : options_(options),
          column_(anyOf(random, 0, options.columns - 1)),
          row_(anyOf(random, 0, options.rows - 1)) {
        for (int k = 0; k < directions; ++k) reach_.push_back(anyOf(random, 1, options.max_range));
    }
    /// Returns one part per direction and, last, the centre.
    [[nodiscard]] CellParts parts() const {
        std::vector<CellSet> sets(reach_.size() + 1, CellSet(cells()));
        for (int row = 0; row < options_.rows; ++row)
            for (int column = 0; column < options_.columns; ++column) {
                const std::size_t part = partAt(column - column_, row - row_);
                if (part <= reach_.size()) sets[part].set(index(column, row));
            }
        CellParts all;
        all.first = {0};
        for (const CellSet& set : sets) {
            const CellParts part = partOf(set);
            all.runs.insert(all.runs.end(), part.runs.begin(), part.runs.end());
            all.first.push_back(static_cast<std::uint32_t>(all.runs.size()));
        }
        return all;
    }
    [[nodiscard]] CellSet whole() const {
        CellSet set(cells());
        for (const CellRun& run : parts().runs)
            for (std::uint32_t cell = run.first; cell < run.end; ++cell) set.set(cell);
        return set;
    }

  private:
    [[nodiscard]] std::size_t cells() const {
        return static_cast<std::size_t>(options_.columns * options_.rows);
    }
    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row * options_.columns + column);
    }
    /// Returns the part of a cell; beyond the last part if it is out of reach.
    [[nodiscard]] std::size_t partAt(int dx, int dy) const {
        if (dx == 0 && dy == 0) return reach_.size();
        constexpr double kTurn = 6.283185307179586;
        const double turn = std::atan2(dy, dx) / kTurn + 0.5 + 1e-9;
        const auto count = reach_.size();
        const std::size_t part =
            static_cast<std::size_t>(turn * static_cast<double>(count)) % count;
        return dx * dx + dy * dy <= reach_[part] * reach_[part] ? part : count + 1;
    }

    RandomProblemOptions options_;
    int column_, row_;
    std::vector<int> reach_;
};

inline std::unique_ptr<CandidateSet> randomCandidates(Random& random,
                                                      const RandomProblemOptions& options) {
    const auto cells = static_cast<std::size_t>(options.columns * options.rows);
    auto candidates = std::make_unique<CandidateSet>(cells);
    for (int site = 0; site < options.sites; ++site) {
        const int directions = 2 * options.headings;
        const Star star(random, options, directions);
        if (site % 3 == 2) {
            candidates->addSite(star.whole());
            continue;
        }
        std::vector<CandidateSet::PartRange> ranges;
        const auto wide = static_cast<std::uint32_t>(anyOf(random, 1, directions));
        for (int k = 0; k < options.headings; ++k)
            ranges.push_back({static_cast<std::uint32_t>(2 * k), wide});
        candidates->addSite(ranges, star.parts());
    }
    return candidates;
}

inline void addOrder(Random& random, Problem& problem) {
    for (std::size_t kind = 0; kind < problem.kinds.size(); ++kind)
        problem.order.insert(problem.order.end(),
                             static_cast<std::size_t>(problem.kinds[kind].most), kind);
    for (std::size_t i = problem.order.size(); i > 1; --i)
        std::swap(problem.order[i - 1], problem.order[random() % i]);
}

/// Calls visit(chosen) for every set of at most `most` different candidates of each kind.
inline void forEachSet(const Problem& problem, std::vector<Choice>& chosen, std::size_t kind,
                       std::size_t first, int left,
                       const std::function<void(const std::vector<Choice>&)>& visit) {
    if (kind == problem.kinds.size()) {
        visit(chosen);
        return;
    }
    const auto most_of = [&](std::size_t of) {
        return of < problem.kinds.size() ? problem.kinds[of].most : 0;
    };
    forEachSet(problem, chosen, kind + 1, 0, most_of(kind + 1), visit);
    if (left == 0) return;
    for (std::size_t i = first; i < problem.kinds[kind].candidates->size(); ++i) {
        chosen.push_back({kind, i});
        forEachSet(problem, chosen, kind, i + 1, left - 1, visit);
        chosen.pop_back();
    }
}

}  // namespace test_problems

/// Creates the same problem for the same seed, on every machine.
inline RandomProblem randomProblem(std::uint64_t seed, const RandomProblemOptions& options = {}) {
    using test_problems::anyOf;
    test_problems::Random random(seed);
    RandomProblem made;
    Problem& problem = made.problem;
    const auto cells = static_cast<std::size_t>(options.columns * options.rows);
    for (std::size_t i = 0; i < cells; ++i)
        problem.weights.push_back(
            random() % 10 == 0 ? 0U
                               : static_cast<std::uint32_t>(anyOf(random, 1, options.max_weight)));
    problem.required = options.required;
    if (options.max_achieved > 0)
        for (std::size_t i = 0; i < cells; ++i)
            problem.achieved.push_back(static_cast<std::uint16_t>(
                std::max(0, anyOf(random, -2 * options.max_achieved, options.max_achieved))));
    double all = 0;
    for (int kind = 0; kind < options.kinds; ++kind) {
        made.candidates.push_back(test_problems::randomCandidates(random, options));
        const double cost = options.has_costs ? 1 + 0.5 * kind : 1;
        const int multiplicity = options.multiplicities.empty()
                                     ? 1
                                     : options.multiplicities[static_cast<std::size_t>(kind)];
        problem.kinds.push_back({made.candidates.back().get(), options.most, cost, multiplicity});
        all += cost * options.most;
    }
    if (options.has_costs) problem.budget = std::max(1.0, std::floor(all) / 2);
    if (options.has_order) test_problems::addOrder(random, problem);
    problem.is_connected = options.is_connected;
    if (options.has_standing) {
        problem.standing = CellSet(cells);
        const std::size_t first = random() % cells;
        for (std::size_t i = first; i < std::min(cells, first + 6); ++i) {
            problem.standing.set(i);
            if (!problem.achieved.empty())
                problem.achieved[i] = std::max<std::uint16_t>(problem.achieved[i], 1);
        }
    }
    return made;
}

/// Finds the best feasible set of choices, the first in the order of enumeration among equals; each
/// candidate of a kind at most once. Enumerates every set: for some ten thousand sets at most.
inline Solution bestByBruteForce(const Problem& problem) {
    Solution best{{}, valueOf(problem, {})};
    if (problem.kinds.empty()) return best;
    std::vector<Choice> chosen;
    test_problems::forEachSet(problem, chosen, 0, 0, problem.kinds[0].most,
                              [&](const std::vector<Choice>& set) {
                                  if (!isFeasible(problem, set)) return;
                                  const std::uint64_t value = valueOf(problem, set);
                                  if (value > best.value) best = {set, value};
                              });
    return best;
}

/// Returns options that combine the features of problems differently in round 0, 1, 2, ...
inline RandomProblemOptions variedOptions(std::uint64_t round) {
    RandomProblemOptions options;
    options.columns = 9;
    options.rows = 7;
    options.max_range = 4;
    options.kinds = round % 3 == 2 ? 2 : 1;
    options.sites = options.kinds == 2 ? 3 : 6;
    options.most = options.kinds == 2 ? 2 : 3;
    options.headings = options.kinds == 2 ? 3 : 4;
    options.max_weight = round % 5 == 4 ? 9 : 1;
    options.required = round % 4 == 3 ? 2 : 1;
    options.max_achieved = round % 4 >= 2 ? 1 : 0;
    if (round % 8 == 7) {
        options.required = 8;
        options.max_achieved = 6;
        options.multiplicities = options.kinds == 2 ? std::vector<int>{4, 1} : std::vector<int>{4};
    }
    options.has_costs = round % 6 == 5;
    options.has_standing = round % 10 == 9;
    return options;
}

inline RandomProblem variedProblem(std::uint64_t round) {
    return randomProblem(1000 + round, variedOptions(round));
}

/// Counts reports and queries, and says stop by a rule on these counts.
class StopWhen final : public Progress {
  public:
    using Rule = std::function<bool(const StopWhen&)>;
    explicit StopWhen(Rule rule) : rule_(std::move(rule)) {}
    void begin(std::string_view phase, std::int64_t /*total*/) override {
        ++begun;
        phases += phase;
        phases += ' ';
    }
    void advance(std::int64_t count) override { done += count; }
    void end() override { ++ended; }
    [[nodiscard]] bool stopped() const override {
        ++asked;
        return rule_(*this);
    }

    std::string phases;  ///< that have begun
    std::atomic<int> begun = 0, ended = 0;
    std::atomic<std::int64_t> done = 0;
    mutable std::atomic<int> asked = 0;  ///< including the current query

  private:
    Rule rule_;
};

/// Says stop at once.
inline bool always(const StopWhen& /*told*/) { return true; }
/// Says stop once more than so many phases have begun.
inline StopWhen::Rule afterPhases(int count) {
    return [count](const StopWhen& told) { return told.begun > count; };
}

/// Says stop after more than so many queries.
inline StopWhen::Rule afterAsking(int times) {
    return [times](const StopWhen& told) { return told.asked > times; };
}

}  // namespace ispace
