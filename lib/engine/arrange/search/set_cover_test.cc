// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/set_cover.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <random>

#include "arrange/search/cover_core.h"
#include "support/test_set_cover.h"

namespace ispace {

namespace set_cover_test {

SetCover randomCover(std::mt19937_64& random, std::size_t rows, std::size_t columns, bool costs) {
    SetCover cover{rows, {}, {}};
    for (std::size_t j = 0; j < columns; ++j) {
        auto& column = cover.columns.emplace_back();
        for (std::uint32_t row = 0; row < rows; ++row)
            if (random() % 4 == 0) column.push_back(row);
        cover.costs.push_back(costs ? static_cast<std::uint32_t>(1 + random() % 7) : 1);
    }
    return cover;
}

bool isCover(const SetCover& problem, const std::vector<std::uint32_t>& chosen) {
    std::vector<bool> seen(problem.rows);
    for (const std::uint32_t j : chosen)
        for (const std::uint32_t row : problem.columns[j]) seen[row] = true;
    return std::find(seen.begin(), seen.end(), false) == seen.end();
}

/// The least cost, of all sets of columns; the largest number without a cover.
std::uint64_t leastOfAll(const SetCover& problem) {
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (std::uint32_t set = 0; set < 1U << problem.columns.size(); ++set) {
        std::vector<std::uint32_t> chosen;
        std::uint64_t cost = 0;
        for (std::uint32_t j = 0; j < problem.columns.size(); ++j)
            if ((set >> j & 1U) != 0) {
                chosen.push_back(j);
                cost += problem.costs[j];
            }
        if (cost < least && isCover(problem, chosen)) least = cost;
    }
    return least;
}

TEST(SetCover, EqualsBruteForce) {
    SilentProgress progress;
    std::mt19937_64 random(7);
    int uncoverable = 0;
    for (int round = 0; round < 200; ++round) {
        const SetCover problem =
            randomCover(random, 4 + random() % 12, 4 + random() % 9, round % 2 == 0);
        const std::uint64_t least = leastOfAll(problem);
        const SetCoverResult result =
            minimumSetCover(problem, {.steps = random() % 40, .tries = 1}, progress);
        ASSERT_EQ(result.is_coverable, least < std::numeric_limits<std::uint64_t>::max()) << round;
        if (!result.is_coverable) {
            ++uncoverable;
            continue;
        }
        ASSERT_EQ(result.cost, least) << round;
        ASSERT_EQ(result.bound, least) << round;
        ASSERT_TRUE(isCover(problem, result.chosen)) << round;
    }
    EXPECT_GT(uncoverable, 10);
    EXPECT_LT(uncoverable, 190);
}

/// Odd cycles without common rows, of which each column covers two neighbours: the linear program
/// takes half of each column, a cover of 2n + 1 rows n + 1 columns.
SetCover oddCycles(std::size_t count, std::uint32_t rows) {
    SetCover cycles{count * rows, {}, std::vector<std::uint32_t>(count * rows, 1)};
    for (std::uint32_t first = 0; first < count * rows; first += rows)
        for (std::uint32_t i = 0; i < rows; ++i)
            cycles.columns.push_back({std::min(first + i, first + (i + 1) % rows),
                                      std::max(first + i, first + (i + 1) % rows)});
    return cycles;
}

TEST(SetCover, CutsProveOddCycles) {
    SilentProgress progress;
    CoverCore core(oddCycles(6, 5));
    EXPECT_LE(raisePrices(core, 18, {1000, 30, 0.1}).value, 15.0);
    const CoverBound bound = raiseByCuts(core, 18, progress);
    EXPECT_GT(bound.value, 17.0);
    EXPECT_LE(bound.value, 18.0);
}

TEST(SetCover, CutsHoldForAllCovers) {
    SilentProgress progress;
    std::mt19937_64 random(23);
    int strict = 0, excluded = 0;
    for (int round = 0; round < 300; ++round) {
        SetCover problem = randomCover(random, 6 + random() % 10, 6 + random() % 7, round % 2 == 0);
        const std::uint64_t least = leastOfAll(problem);
        if (least == std::numeric_limits<std::uint64_t>::max()) continue;
        CoverCore core(problem);
        const double limit = static_cast<double>(least + round % 3);
        const CoverBound bound = raiseByCuts(core, limit, progress);
        ASSERT_LE(bound.value, static_cast<double>(least)) << round;
        strict += raisePrices(core, limit, {1000, 30, 0.1}).value < bound.value - 0.01 ? 1 : 0;
        // A cover with an excluded column costs the limit at least.
        for (std::size_t j = 0; j < problem.columns.size(); ++j) {
            if (bound.excluded[j] == 0) continue;
            ++excluded;
            SetCover with = problem;  // a row of this column alone forces it
            with.columns[j].push_back(static_cast<std::uint32_t>(with.rows++));
            ASSERT_GE(static_cast<double>(leastOfAll(with)), limit) << round;
        }
    }
    EXPECT_GT(strict, 20);
    EXPECT_GT(excluded, 100);
}

TEST(SetCover, ComponentsAddUp) {
    SilentProgress progress;
    const SetCover problem = oddCycles(9, 7);
    const CoverCore core(problem);
    const std::vector<CoverCore> parts = core.components();
    ASSERT_EQ(parts.size(), 9U);
    for (const CoverCore& part : parts) {
        EXPECT_EQ(part.rows(), 7U);
        EXPECT_EQ(part.columns(), 7U);
    }
    const SetCoverResult result = minimumSetCover(problem, {.steps = 100}, progress);
    EXPECT_TRUE(isCover(problem, result.chosen));
    EXPECT_EQ(result.cost, 36U);
    EXPECT_EQ(result.bound, 36U);
}

/// The points on the lines of the plane of order 3: 13 columns that symmetries map to each other.
TEST(SetCover, FindsTheOrbitsOfAProjectivePlane) {
    SetCover plane{13, std::vector<std::vector<std::uint32_t>>(13),
                   std::vector<std::uint32_t>(13, 1)};
    for (std::uint32_t line = 0; line < 13; ++line)
        for (const std::uint32_t step : {0U, 1U, 3U, 9U})
            plane.columns[(line + step) % 13].push_back(line);
    EXPECT_EQ(columnOrbits(CoverCore(plane)), std::vector<std::uint32_t>(13, 0));
    plane.costs[5] = 2;  // a point apart
    const std::vector<std::uint32_t> orbits = columnOrbits(CoverCore(plane));
    for (std::uint32_t j = 0; j < 13; ++j) EXPECT_EQ(orbits[j], j == 5 ? 5U : 0U) << j;
    SilentProgress progress;
    // A line meets all others: four points, at least.
    EXPECT_EQ(minimumSetCover(plane, {}, progress).bound, 4U);
}

TEST(SetCover, ThreadsDoNotMatter) {
    SilentProgress progress;
    std::mt19937_64 random(11);
    const SetCover problem = randomCover(random, 120, 90, true);
    std::vector<SetCoverResult> results;
    for (const std::size_t threads : {1U, 4U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(minimumSetCover(problem, {.steps = 50}, progress));
    }
    EXPECT_EQ(results[0].chosen, results[1].chosen);
    EXPECT_EQ(results[0].bound, results[0].cost);
    EXPECT_EQ(results[1].bound, results[1].cost);
}

TEST(SetCover, ProvesInstancesOfTheOrLibrary) {
    const char* folder = std::getenv("ISPACE_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA is not set";
    SilentProgress progress;
    for (const KnownCover& known : kKnownCovers) {
        if (!known.is_proven || known.file == std::string("scpclr10.txt")) continue;  // for long
        const SetCover problem = readSetCover(std::string(folder) + "/scp/" + known.file);
        const SetCoverResult result = minimumSetCover(problem, {}, progress);
        EXPECT_TRUE(isCover(problem, result.chosen)) << known.file;
        EXPECT_EQ(result.cost, known.cost) << known.file;
        EXPECT_EQ(result.bound, known.cost) << known.file;
    }
}

}  // namespace set_cover_test

}  // namespace ispace
