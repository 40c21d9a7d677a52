// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/search.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <string>

#include "support/test_problems.h"

namespace ispace {

namespace search_test {

/// Says stop after so many steps, and stores the reports.
class DetectionMonitor final : public Progress {
  public:
    explicit DetectionMonitor(int left = 1'000'000'000, std::string_view last = {})
        : left_(left), last_(last) {}
    void begin(std::string_view phase, std::int64_t /*total*/) override {
        if (phase == last_) left_ = 0;
        phases += phase;
        phases += ' ';
    }
    void advance(std::int64_t /*count*/) override { --left_; }
    void note(std::string_view text) override { last_note = text; }
    void end() override {}
    [[nodiscard]] bool stopped() const override { return left_ <= 0; }

    std::string phases, last_note;

  private:
    std::atomic<int> left_;
    std::string_view last_;  // ends where this phase begins
};

TEST(Search, SeriesOfSimilarProblemsKeepsValuesAndBounds) {
    std::uint64_t apart = 0, in_series = 0;
    for (std::uint64_t round = 0; round < 20; ++round) {
        RandomProblem random = randomProblem(round, {});
        SimilarSearch similar;
        DetectionMonitor first, last;
        for (int count = 1; count <= 3; ++count) {
            for (SensorType& kind : random.problem.kinds) {
                kind.most = 3;
                kind.cost = 1;
            }
            random.problem.order.clear();
            random.problem.budget = count;
            SearchOptions options;
            const SearchResult alone = search(random.problem, options, first);
            options.similar = &similar;
            const SearchResult result = search(random.problem, options, last);
            const std::uint64_t best = bestByBruteForce(random.problem).value;
            ASSERT_GE(result.bound, best) << round;
            ASSERT_LE(result.best.value, best) << round;
            ASSERT_TRUE(isFeasible(random.problem, result.best.chosen)) << round;
            ASSERT_EQ(similar.multipliers.size(), random.problem.cells());
            for (const auto& chosen : similar.starts)
                ASSERT_TRUE(isFeasible(random.problem, chosen)) << round;
            apart += alone.best.value;
            in_series += result.best.value;
        }
    }
    EXPECT_GE(in_series, apart);
}

TEST(Search, ValueIsBelowTheBestAndBoundAbove) {
    SilentProgress progress;
    for (std::uint64_t round = 0; round < 60; ++round) {
        RandomProblemOptions varied = variedOptions(round);
        varied.is_connected = round % 7 == 0;
        const RandomProblem random = randomProblem(round, varied);
        const std::uint64_t best = bestByBruteForce(random.problem).value;
        for (const Optimizer optimizer : {Optimizer::Greedy, Optimizer::Swap, Optimizer::Exact}) {
            SearchOptions options;
            options.optimizer = optimizer;
            options.swap.starts = 3;
            const SearchResult result = search(random.problem, options, progress);
            ASSERT_LE(result.best.value, best) << round;
            ASSERT_GE(result.bound, best) << round;
            ASSERT_TRUE(isFeasible(random.problem, result.best.chosen)) << round;
            ASSERT_EQ(valueOf(random.problem, result.best.chosen), result.best.value);
            ASSERT_TRUE(result.is_complete);
            if (optimizer != Optimizer::Exact) continue;
            ASSERT_EQ(result.best.value, best) << round;
            ASSERT_EQ(result.bound, best) << round;
        }
    }
}

TEST(Search, TellsValueAndBound) {
    DetectionMonitor watch;
    RandomProblemOptions options;
    options.most = 2;
    const RandomProblem random = randomProblem(4, options);
    search(random.problem, {.optimizer = Optimizer::Exact}, watch);
    EXPECT_NE(watch.phases.find("bounding"), std::string::npos);
    EXPECT_NE(watch.last_note.find("at most"), std::string::npos);
}

TEST(Search, StoppedAnywhereGivesTheBestSoFar) {
    RandomProblemOptions options;
    options.columns = 20;
    options.rows = 16;
    options.sites = 20;
    options.most = 3;
    const RandomProblem random = randomProblem(8, options);
    SilentProgress silent;
    const SearchResult exact = search(random.problem, {.optimizer = Optimizer::Exact}, silent);
    for (const int steps : {0, 1, 2, 4, 8, 16, 32}) {
        DetectionMonitor watch(steps);
        const SearchResult result = search(random.problem, {.optimizer = Optimizer::Exact}, watch);
        EXPECT_LE(result.best.value, exact.best.value);
        EXPECT_GE(result.bound, exact.best.value);
        EXPECT_TRUE(isFeasible(random.problem, result.best.chosen));
        EXPECT_TRUE(!result.is_complete || result.bound == result.best.value) << steps;
    }
    DetectionMonitor at_once(0);
    const SearchResult nothing = search(random.problem, {}, at_once);
    EXPECT_GE(nothing.bound, exact.best.value);
    EXPECT_LT(nothing.bound, random.problem.totalWeight());
    // There is time for a greedy layout.
    EXPECT_EQ(nothing.best.chosen, placeGreedily(random.problem, silent).chosen);
}

TEST(Search, HasABoundBeforeTheSwaps) {
    RandomProblemOptions options;
    options.columns = 50;
    options.rows = 50;
    options.sites = 120;
    options.max_range = 12;
    options.most = 12;
    const RandomProblem random = randomProblem(3, options);
    DetectionMonitor watch(1'000'000'000, "improving");
    const SearchResult result = search(random.problem, {}, watch);
    EXPECT_FALSE(result.is_complete);
    EXPECT_LT(result.bound, result.best.value * 12 / 10);
}

/// How many rounds of kicks there were before the tree, where search ends.
class KickRounds final : public Progress {
  public:
    void begin(std::string_view phase, std::int64_t /*total*/) override {
        phase_ = phase;
        if (phase == "bounding") rounds = 0;
    }
    void advance(std::int64_t /*count*/) override {
        if (phase_ == "improving") ++rounds;
    }
    void end() override {}
    [[nodiscard]] bool stopped() const override { return phase_ == "proving"; }

    int rounds = 0;

  private:
    std::string phase_;
};

TEST(Search, KicksLongerBeforeALargeTree) {
    RandomProblemOptions options;
    options.columns = 50;
    options.rows = 50;
    options.sites = 40;
    options.max_range = 18;
    const auto rounds = [&options](double gap) {
        KickRounds progress;
        const RandomProblem random = randomProblem(0, options);
        search(random.problem, {.optimizer = Optimizer::Exact, .gap = gap}, progress);
        return progress.rounds;
    };
    options.most = 8;
    EXPECT_GE(rounds(0), 2);
    EXPECT_EQ(rounds(0.1), 0);
    // A tree that does not branch on areas.
    options.most = 4;
    EXPECT_LE(rounds(0), 1);
}

TEST(Search, IsTheSameForAnyNumberOfThreads) {
    RandomProblemOptions options;
    options.columns = 24;
    options.rows = 20;
    options.sites = 40;
    options.most = 3;
    const RandomProblem random = randomProblem(21, options);
    SilentProgress progress;
    const auto searched = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return search(random.problem, {.optimizer = Optimizer::Exact}, progress);
    };
    const SearchResult one = searched(1), two = searched(2);
    EXPECT_EQ(one.best.chosen, two.best.chosen);
    EXPECT_EQ(one.bound, two.bound);
}

TEST(Search, NothingToPlace) {
    Problem problem;
    problem.weights = {3, 4};
    problem.achieved = {1, 0};
    SilentProgress progress;
    const CandidateSet none(2);
    for (const int most : {0, 2}) {
        problem.kinds = {{&none, most, 1, 1}};
        const SearchResult result = search(problem, {.optimizer = Optimizer::Exact}, progress);
        EXPECT_EQ(result.best.value, 3U);
        EXPECT_EQ(result.bound, 3U);
        EXPECT_TRUE(result.best.chosen.empty());
    }
}

}  // namespace search_test

}  // namespace ispace
