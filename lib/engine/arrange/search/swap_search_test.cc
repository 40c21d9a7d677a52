// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <mutex>
#include <string>

#include "arrange/search/local_search.h"
#include "arrange/search/search.h"
#include "support/test_problems.h"

namespace ispace {
namespace swap_search_test {

Solution improved(const Problem& problem, int starts = 20, std::uint64_t seed = 0) {
    SilentProgress progress;
    const Solution start = placeGreedily(problem, progress);
    return improveBySwaps(problem, start, {starts, seed}, progress);
}

/// Kinds in order, as the problem asks for.
std::vector<std::size_t> kindsOf(const std::vector<Choice>& chosen) {
    std::vector<std::size_t> kinds;
    for (const Choice& choice : chosen) kinds.push_back(choice.kind);
    return kinds;
}

/// How often the swaps end in the optimum; checks value and feasibility of each result.
int countOptima(const RandomProblemOptions& options, std::uint64_t seeds) {
    SilentProgress progress;
    int count = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        const Solution start = placeGreedily(made.problem, progress);
        const Solution end = improveBySwaps(made.problem, start, {}, progress);
        EXPECT_EQ(end.value, valueOf(made.problem, end.chosen)) << seed;
        EXPECT_GE(end.value, start.value) << seed;
        EXPECT_TRUE(isFeasible(made.problem, end.chosen)) << seed;
        if (options.has_order) {
            EXPECT_EQ(kindsOf(end.chosen), made.problem.order) << seed;
        }
        const std::uint64_t best = bestByBruteForce(made.problem).value;
        EXPECT_LE(end.value, best) << seed;
        if (end.value == best) ++count;
    }
    return count;
}

TEST(SwapSearch, FindsTheOptimumOfAlmostAllRandomProblems) {
    RandomProblemOptions options;
    options.columns = 16;
    options.max_weight = 4;
    options.sites = 9;
    EXPECT_GE(countOptima(options, 60), 59);
}

TEST(SwapSearch, FindsTheOptimumOfSeveralKindsInOrder) {
    RandomProblemOptions options;
    options.kinds = 2;
    options.sites = 4;
    options.most = 2;
    options.has_order = true;
    EXPECT_GE(countOptima(options, 40), 39);
}

TEST(SwapSearch, FindsTheOptimumWithDemand) {
    RandomProblemOptions options;
    options.kinds = 2;
    options.sites = 4;
    options.most = 2;
    options.required = 2;
    options.multiplicities = {1, 2};
    options.max_achieved = 1;
    options.max_weight = 3;
    EXPECT_GE(countOptima(options, 40), 38);
}

TEST(SwapSearch, FindsTheOptimumWhereItTakesSeveral) {
    RandomProblemOptions options;
    options.sites = 6;
    options.most = 4;
    for (options.required = 2; options.required <= 3; ++options.required)
        EXPECT_GE(countOptima(options, 20), 19);
}

TEST(SwapSearch, FindsTheOptimumWithinABudget) {
    RandomProblemOptions options;
    options.kinds = 3;
    options.sites = 3;
    options.headings = 2;
    options.most = 2;
    options.has_costs = true;
    EXPECT_GE(countOptima(options, 40), 39);
}

/// Cheap sensors that see two cells each, dear ones that see three and five.
TEST(SwapSearch, BuysTwoForOneAndOneForTwo) {
    const std::size_t cells = 8;
    const auto set_of = [](std::size_t first, std::size_t end) {
        CellSet set(cells);
        for (std::size_t cell = first; cell < end; ++cell) set.set(cell);
        return set;
    };
    CandidateSet cheap(cells), dear(cells);
    cheap.addSite(set_of(0, 2));
    cheap.addSite(set_of(2, 4));
    dear.addSite(set_of(0, 3));
    Problem problem;
    problem.weights.assign(cells, 1);
    problem.kinds = {{&cheap, 2, 1, 1}, {&dear, 1, 2, 1}};
    problem.budget = 2;
    SilentProgress progress;
    const Solution two = improveBySwaps(problem, {{{1, 0}}, 3}, {0, 0}, progress);
    EXPECT_EQ(two.value, 4U);
    dear.addSite(set_of(3, 8));
    const Solution one = improveBySwaps(problem, two, {0, 0}, progress);
    EXPECT_EQ(one.chosen, (std::vector<Choice>{{1, 1}}));
}

TEST(SwapSearch, FindsTheOptimumConnected) {
    RandomProblemOptions options;
    options.columns = 20;
    options.sites = 9;
    options.max_range = 4;
    options.is_connected = true;
    EXPECT_GE(countOptima(options, 40), 36);
    options.has_standing = true;
    EXPECT_GE(countOptima(options, 40), 36);
}

TEST(SwapSearch, EndsWhereNoSingleMoveHelps) {
    RandomProblemOptions options;
    options.sites = 30;
    options.columns = 30;
    options.most = 6;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        const Solution end = improved(made.problem, 0);
        for (std::size_t i = 0; i < end.chosen.size(); ++i)
            for (std::size_t c = 0; c < made.candidates[0]->size(); ++c) {
                auto other = end.chosen;
                other[i].candidate = c;
                EXPECT_LE(valueOf(made.problem, other), end.value) << seed;
            }
    }
}

TEST(SwapSearch, IsTheSameForAnyNumberOfThreads) {
    RandomProblemOptions options;
    options.sites = 60;
    options.columns = 40;
    options.rows = 30;
    options.most = 5;
    for (const int required : {1, 2}) {
        options.required = required;
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            options.is_connected = seed >= 2;
            options.kinds = 1 + static_cast<int>(seed % 2);
            options.has_costs = seed == 1;
            const RandomProblem made = randomProblem(seed, options);
            Solution single;
            {
                const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
                single = improved(made.problem, 20, seed);
            }
            const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 8);
            for (int repeat = 0; repeat < 3; ++repeat) {
                const Solution other = improved(made.problem, 20, seed);
                EXPECT_EQ(other.chosen, single.chosen) << seed;
                EXPECT_EQ(other.value, single.value) << seed;
            }
        }
    }
}

TEST(SwapSearch, MoreStartsAreNeverWorseThanGreedyAlone) {
    RandomProblemOptions options;
    options.sites = 40;
    options.columns = 30;
    options.most = 6;
    int better = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        const std::uint64_t value = improved(made.problem, 0).value;
        const std::uint64_t more = improved(made.problem, 20).value;
        EXPECT_GE(more, value);
        if (more > value) ++better;
    }
    EXPECT_GE(better, 1);
}

TEST(SwapSearch, TrivialProblems) {
    const CandidateSet none(2);
    CandidateSet one(2);
    one.addSite(CellSet(2));
    Problem problem;
    problem.weights = {1, 1};
    EXPECT_TRUE(improved(problem).chosen.empty());
    problem.kinds = {{&none, 3}};
    EXPECT_TRUE(improved(problem).chosen.empty());
    problem.kinds = {{&none, 3}, {&one, 2}};
    EXPECT_EQ(improved(problem).chosen, (std::vector<Choice>{{1, 0}, {1, 0}}));
    problem.budget = 0;
    EXPECT_TRUE(improved(problem).chosen.empty());
    problem.weights = {0, 0};
    EXPECT_EQ(improved(problem).value, 0U);
}

/// Says stop after it was asked some times.
class StopAfter final : public Progress {
  public:
    explicit StopAfter(int times) : left_(times) {}
    void begin(std::string_view phase, std::int64_t total) override {
        phase_ = phase;
        total_ = total;
    }
    void advance(std::int64_t count) override { done_ += count; }
    void note(std::string_view text) override {
        const std::lock_guard lock(mutex_);
        note_ = text;
    }
    void end() override {}
    [[nodiscard]] bool stopped() const override { return --left_ < 0; }

    std::string phase_, note_;
    std::int64_t total_ = 0;
    std::atomic<std::int64_t> done_ = 0;

  private:
    mutable std::atomic<int> left_;
    std::mutex mutex_;
};

TEST(SwapSearch, StoppedItKeepsWhatItHas) {
    RandomProblemOptions options;
    options.sites = 30;
    options.columns = 30;
    options.most = 5;
    const RandomProblem made = randomProblem(2, options);
    SilentProgress silent;
    const Solution start = placeGreedily(made.problem, silent);
    for (const int times : {0, 1, 10, 50, 200}) {
        StopAfter progress(times);
        const Solution end = improveBySwaps(made.problem, start, {}, progress);
        EXPECT_GE(end.value, start.value);
        EXPECT_EQ(end.chosen.size(), 5U);
        EXPECT_EQ(end.value, valueOf(made.problem, end.chosen));
    }
}

TEST(SwapSearch, TellsHowFarItIs) {
    for (const int required : {1, 2}) {
        RandomProblemOptions options;
        options.required = required;
        options.max_achieved = required - 1;
        options.most = required == 1 ? 3 : 12;  // more than are random: placed greedily
        const RandomProblem made = randomProblem(2, options);
        StopAfter progress(1 << 30);
        improveBySwaps(made.problem, {}, {}, progress);
        EXPECT_EQ(progress.phase_, "improving");
        EXPECT_EQ(progress.total_, 25);
        EXPECT_EQ(progress.done_, progress.total_);
        EXPECT_EQ(progress.note_.substr(0, 5), "best ");
    }
}

TEST(SwapSearch, EndsWhereItIsEnough) {
    RandomProblemOptions options;
    options.sites = 60;
    options.columns = 40;
    options.rows = 30;
    options.max_range = 10;
    options.most = 10;
    int less = 0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        const RandomProblem made = randomProblem(seed, options);
        SilentProgress progress;
        const std::uint64_t most = improved(made.problem).value;
        for (const std::uint64_t enough : {most * 8 / 10, most * 97 / 100, most, most + 1}) {
            Solution found[2];
            for (const std::size_t threads : {1U, 8U}) {
                const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                                  threads);
                found[threads / 8] = improveBySwaps(made.problem, {}, {20, 0, enough}, progress);
            }
            EXPECT_EQ(found[0].chosen, found[1].chosen) << seed;
            EXPECT_EQ(found[0].value, found[1].value) << seed;
            EXPECT_GE(found[0].value, std::min(enough, most * 98 / 100)) << seed;
            if (found[0].value < most) ++less;
        }
        // A start of sufficient value is returned unchanged.
        const Solution start = placeGreedily(made.problem, progress);
        EXPECT_EQ(improveBySwaps(made.problem, start, {20, 0, start.value}, progress).chosen,
                  start.chosen);
    }
    EXPECT_GT(less, 4);
}

TEST(ResponseCache, KnowsChoicesInAnyOrder) {
    using Key = ResponseCache::Key;
    EXPECT_EQ(Key({{0, 1}, {1, 0}}), Key({{1, 0}, {0, 1}}));
    EXPECT_FALSE(Key({{0, 1}}) == Key({{1, 0}}));
    EXPECT_FALSE(Key({{0, 1}, {0, 1}}) == Key(std::vector<Choice>()));
    ResponseCache cache;
    const std::size_t stored = 200'000;
    std::size_t found = 0;
    for (std::size_t i = 0; i < stored; ++i) cache.store(Key({{0, i}}), {{0, i}, i, true});
    for (std::size_t i = 0; i < stored; ++i) {
        const auto response = cache.find(Key({{0, i}}));
        if (!response) continue;
        ++found;
        ASSERT_EQ(response->choice.candidate, i);
    }
    EXPECT_EQ(found, 100'000U);
}

}  // namespace swap_search_test
}  // namespace ispace
