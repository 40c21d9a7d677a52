// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/worst_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <memory>

#include "support/test_problems.h"

namespace ispace {
namespace worst_case_test {

/// Calls visit(set) for every set of at most `most` candidates.
void forEachLayout(const Problem& problem,
                   const std::function<void(const std::vector<Choice>&)>& visit) {
    std::vector<Choice> chosen;
    test_problems::forEachSet(problem, chosen, 0, 0, problem.kinds[0].most, visit);
}

/// A problem of three blocks: rows of the grid.
struct BlockProblem {
    RandomProblem made;
    WorstCaseProblem cases;

    static RandomProblemOptions optionsOf(std::uint64_t seed) {
        RandomProblemOptions options;
        options.rows = 9;
        options.kinds = seed % 3 == 0 ? 2 : 1;
        options.sites = seed % 3 == 0 ? 3 : 5;
        options.headings = 3;
        options.most = 2;
        options.max_weight = seed % 2 == 0 ? 5 : 1;
        options.max_achieved = seed % 4 == 1 ? 1 : 0;
        options.required = seed % 4 == 1 ? 2 : 1;
        return options;
    }
    explicit BlockProblem(std::uint64_t seed) : made(randomProblem(seed, optionsOf(seed))) {
        cases.problem = &made.problem;
        for (std::size_t b = 0; b < 3; ++b) cases.blocks.push_back({36 * b, 36 * (b + 1)});
    }
    /// Returns the least share of a block, in units of the first.
    [[nodiscard]] std::uint64_t valueByHand(const std::vector<Choice>& chosen) const {
        std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
        for (const CellBlock& block : cases.blocks) {
            Problem own = made.problem;
            for (std::size_t i = 0; i < own.cells(); ++i)
                if (i < block.first || i >= block.end) own.weights[i] = 0;
            Problem first = made.problem;
            std::fill(first.weights.begin() + 36, first.weights.end(), 0U);
            least = std::min(least, valueOf(own, chosen) * first.totalWeight() / own.totalWeight());
        }
        return least;
    }
};

TEST(WorstCase, OfBlocksIsThatOfBruteForce) {
    SilentProgress silent;
    int proven = 0;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        const BlockProblem blocks(seed);
        std::uint64_t best = 0;
        forEachLayout(blocks.made.problem, [&](const std::vector<Choice>& chosen) {
            const std::uint64_t value = blocks.valueByHand(chosen);
            EXPECT_EQ(worstCase(blocks.cases, chosen).value, value);
            best = std::max(best, value);
        });
        for (const Optimizer optimizer : kOptimizers) {
            const SearchResult found =
                searchWorstCase(blocks.cases, {.optimizer = optimizer}, silent);
            EXPECT_EQ(found.best.value, blocks.valueByHand(found.best.chosen)) << seed;
            EXPECT_LE(found.best.value, best) << seed;
            EXPECT_GE(found.bound, best) << seed;
            EXPECT_TRUE(isWithinLimits(blocks.made.problem, found.best.chosen));
            if (optimizer == Optimizer::Greedy) continue;
            EXPECT_GE(found.best.value, best * 9 / 10) << seed;
            proven += found.bound == best ? 1 : 0;
            if (optimizer == Optimizer::Swap) continue;
            EXPECT_EQ(found.best.value, best) << seed;
            EXPECT_EQ(found.bound, best) << seed;
        }
    }
    EXPECT_GE(proven, 24);  // all of Exact
}

TEST(WorstCase, OfOneBlockIsThePlainSearch) {
    SilentProgress silent;
    const RandomProblem made = randomProblem(5);
    const WorstCaseProblem one{&made.problem, {{0, made.problem.cells()}}};
    const SearchOptions exact{.optimizer = Optimizer::Exact};
    const SearchResult found = searchWorstCase(one, exact, silent);
    EXPECT_EQ(found.best.value, search(made.problem, exact, silent).best.value);
    EXPECT_EQ(found.bound, found.best.value);
}

/// A plain problem, and the same for the failure of K sensors.
struct FailingProblem {
    RandomProblem plain;
    std::vector<CellSet> standing;
    std::vector<std::unique_ptr<CandidateSet>> candidates;
    Problem layered;
    WorstCaseProblem cases;
    std::size_t failures;

    static RandomProblemOptions optionsOf(std::uint64_t seed) {
        RandomProblemOptions options;
        options.kinds = seed % 3 == 0 ? 2 : 1;
        options.sites = seed % 3 == 0 ? 3 : 4;
        options.headings = 3;
        options.most = seed % 3 == 0 ? 2 : 3;
        options.max_weight = seed % 2 == 0 ? 7 : 1;
        return options;
    }
    FailingProblem(std::uint64_t seed, std::size_t count)
        : plain(randomProblem(seed, optionsOf(seed))), failures(count) {
        const std::size_t cells = plain.problem.cells();
        std::vector<std::uint16_t> seen(cells);
        if (seed % 2 == 1) {
            CellSet own(cells * (count + 1));
            for (std::size_t i = 40; i < 70; ++i) {
                ++seen[i];
                for (std::size_t m = 0; m <= count; ++m) own.set(m * cells + i);
            }
            standing.push_back(own);
        }
        Problem bare = plain.problem;
        std::size_t sensors = standing.size();
        for (SensorType& kind : bare.kinds) {
            sensors += static_cast<std::size_t>(kind.most);
            auto& set =
                candidates.emplace_back(std::make_unique<CandidateSet>(cells * (count + 1)));
            for (std::size_t i = 0; i < kind.candidates->size(); ++i) {
                CellSet view(cells * (count + 1));
                kind.candidates->cellsOf(i).forEach([&](std::size_t cell) {
                    for (std::size_t m = 0; m <= count; ++m) view.set(m * cells + cell);
                });
                set->addSite(view);
            }
            kind.candidates = set.get();
        }
        FailureProblem made = failureProblem(bare, seen, sensors, count);
        layered = std::move(made.problem);
        EXPECT_EQ(made.least_total, layered.totalWeight());
        cases = {&layered, {{0, cells}}, static_cast<int>(count), standing, made.least_total};
        unit_ = cases.totalOf(0) / plain.problem.totalWeight();
        total_ = sensors;
        // Of the plain problem:
        plain.problem.achieved = seen;
    }

    /// Returns the plain value of each case, standing sensor first, for a full layout.
    [[nodiscard]] std::vector<std::uint64_t> valuesByHand(std::vector<Choice> chosen) const {
        std::vector<std::uint64_t> values;
        const std::size_t count = standing.size() + chosen.size();
        for (std::size_t bits = 0; bits < std::size_t{1} << count; ++bits) {
            if (static_cast<std::size_t>(std::popcount(bits)) != std::min(failures, count))
                continue;
            Problem left = plain.problem;
            if (!standing.empty() && (bits & 1U))
                std::fill(left.achieved.begin(), left.achieved.end(), 0);
            std::vector<Choice> rest;
            for (std::size_t i = 0; i < chosen.size(); ++i)
                if (!((bits >> (i + standing.size())) & 1U)) rest.push_back(chosen[i]);
            values.push_back(valueOf(left, rest));
        }
        return values;
    }
    [[nodiscard]] std::size_t sensors() const { return total_; }
    /// Returns the value of a weight of 1 in the cases.
    [[nodiscard]] std::uint64_t unit() const { return unit_; }

  private:
    std::size_t total_ = 0;
    std::uint64_t unit_ = 1;
};

TEST(WorstCase, OfFailuresIsThatOfBruteForce) {
    SilentProgress silent;
    for (std::uint64_t seed = 0; seed < 16; ++seed)
        for (std::size_t failures = 1; failures <= 2; ++failures) {
            const FailingProblem failing(seed, failures);
            std::uint64_t best = 0, best_mean = 0;
            forEachLayout(failing.plain.problem, [&](const std::vector<Choice>& chosen) {
                const auto values = failing.valuesByHand(chosen);
                const std::uint64_t worst =
                    failing.unit() * *std::min_element(values.begin(), values.end());
                EXPECT_EQ(worstCase(failing.cases, chosen).value, worst) << seed;
                best = std::max(best, worst);
                if (chosen.size() + failing.standing.size() != failing.sensors()) return;
                // The number of cases times the mean.
                std::uint64_t sum = 0;
                for (const std::uint64_t value : values) sum += value;
                EXPECT_EQ(valueOf(failing.layered, chosen), sum) << seed;
                best_mean = std::max(best_mean, sum);
            });
            const SearchOptions exact{.optimizer = Optimizer::Exact};
            for (const Optimizer optimizer : kOptimizers) {
                const SearchResult found =
                    searchWorstCase(failing.cases, {.optimizer = optimizer}, silent);
                EXPECT_EQ(found.best.value, worstCase(failing.cases, found.best.chosen).value);
                EXPECT_LE(found.best.value, best);
                EXPECT_GE(found.bound, best) << seed;
                if (optimizer != Optimizer::Exact) continue;
                EXPECT_EQ(found.best.value, best) << seed << ' ' << failures;
                EXPECT_EQ(found.bound, best) << seed << ' ' << failures;
            }
            const SearchResult mean = search(failing.layered, exact, silent);
            EXPECT_EQ(mean.best.value, best_mean) << seed;
            EXPECT_EQ(mean.bound, best_mean) << seed;
        }
}

TEST(WorstCase, LargeNumbersOfFailuresKeepTheWeightsInRange) {
    Problem plain;
    plain.weights.assign(1000, 1000);
    const std::vector<std::uint16_t> seen(1000);
    const FailureProblem many = failureProblem(plain, seen, 60, 6);
    const Problem& problem = many.problem;
    EXPECT_LT(problem.totalWeight(), std::uint64_t{1} << 32U);
    EXPECT_LT(many.least_total, problem.totalWeight());
    EXPECT_GT(many.least_total, problem.totalWeight() * 99 / 100);
    EXPECT_EQ(problem.cells(), 7000U);
    // C(59, 6) : C(58, 5)
    EXPECT_NEAR(static_cast<double>(problem.weights[0]) / problem.weights[1000], 59.0 / 6, 0.1);
    EXPECT_EQ(problem.weights[6000], 1000U);  // rounded up from 1 of 50 million
}

TEST(WorstCase, AllFailIfThereAreNotMore) {
    const FailingProblem failing(2, 2);
    const CaseValue none = worstCase(failing.cases, {});
    EXPECT_EQ(none.value, 0U);
    const CaseValue one = worstCase(failing.cases, {{0, 0}});
    EXPECT_EQ(one.value, 0U);
    EXPECT_EQ(one.failed, std::vector<std::size_t>{0});
}

}  // namespace worst_case_test
}  // namespace ispace
