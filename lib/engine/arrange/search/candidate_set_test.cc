// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/cover_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace ispace {
namespace candidate_set_test {

using Random = std::mt19937_64;

/// Creates disjoint parts of random cells: cell i lies in part where[i], if there is such a part.
CellParts partsOf(const std::vector<std::size_t>& where, std::size_t parts) {
    CellParts all;
    all.first = {0};
    for (std::size_t part = 0; part < parts; ++part) {
        CellSet cells(where.size());
        for (std::size_t cell = 0; cell < where.size(); ++cell)
            if (where[cell] == part) cells.set(cell);
        for (const CellRun& run : partOf(cells).runs) all.runs.push_back(run);
        all.first.push_back(static_cast<std::uint32_t>(all.runs.size()));
    }
    return all;
}

/// Runs of random lengths; `share` of them in a part.
std::vector<std::size_t> randomParts(Random& random, std::size_t cells, std::size_t parts,
                                     double share) {
    std::vector<std::size_t> where;
    where.reserve(cells);
    while (where.size() < cells) {
        const bool is_seen = std::uniform_real_distribution<double>(0, 1)(random) < share;
        const std::size_t part = is_seen ? random() % parts : parts;
        for (std::size_t n = 1 + random() % 20; n > 0 && where.size() < cells; --n)
            where.push_back(part);
    }
    return where;
}

std::vector<std::uint32_t> randomWeights(Random& random, std::size_t cells) {
    std::vector<std::uint32_t> weights(cells);
    for (std::uint32_t& weigh : weights) weigh = static_cast<std::uint32_t>(random() % 1000);
    return weights;
}

std::uint32_t weightOf(const CellSet& cells, const std::vector<std::uint32_t>& weights) {
    std::uint32_t sum = 0;
    cells.forEach([&](std::size_t cell) { sum += weights[cell]; });
    return sum;
}

/// A set and the expected views of its candidates.
struct Model {
    CandidateSet set;
    std::vector<CellSet> seen;

    explicit Model(std::size_t cells) : set(cells) {}
    void addRandomSite(Random& random, std::size_t directed) {
        const std::size_t cells = set.cells();
        const auto where = randomParts(random, cells, directed + 1, 0.6);
        std::vector<CandidateSet::PartRange> ranges;
        const std::size_t count = 1 + random() % 6;
        for (std::size_t k = 0; k < count; ++k) {
            const auto begin = static_cast<std::uint32_t>(directed == 0 ? 0 : random() % directed);
            const auto size = static_cast<std::uint32_t>(random() % (directed + 1));
            ranges.push_back({begin, size});
            CellSet all(cells);
            for (std::size_t cell = 0; cell < cells; ++cell) {
                if (where[cell] > directed) continue;
                const std::size_t turn = (where[cell] + directed - begin) % std::max(directed, 1UL);
                if (where[cell] == directed || turn < size) all.set(cell);
            }
            seen.push_back(std::move(all));
        }
        set.addSite(ranges, partsOf(where, directed + 1));
    }
};

TEST(CandidateSet, HandMade) {
    CandidateSet set(10);
    // Parts {0, 1}, {2}, {5, 6, 7}, and {9} for all.
    const std::vector<CandidateSet::PartRange> ranges = {{0, 2}, {2, 2}};
    set.addSite(ranges, {{{0, 2}, {2, 3}, {5, 8}, {9, 10}}, {0, 1, 2, 3, 4}});
    CellSet only(10);
    only.set(4);
    set.addSite(only);
    ASSERT_EQ(set.size(), 3U);
    ASSERT_EQ(set.sites(), 2U);
    EXPECT_EQ(set.runs(), 5U);
    EXPECT_EQ(set.firstOf(1), 2U);
    EXPECT_EQ(set.firstOf(2), 3U);
    EXPECT_EQ(set.siteOf(1), 0U);
    EXPECT_EQ(set.siteOf(2), 1U);
    const std::vector<std::uint32_t> powers = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512};
    std::vector<std::uint32_t> values(3);
    set.weighAll(WeightSums(powers), values);
    EXPECT_EQ(values, (std::vector<std::uint32_t>{7 + 512, 32 + 64 + 128 + 3 + 512, 16}));
    EXPECT_EQ(set.cellsOf(2), only);
    EXPECT_EQ(set.directedParts(0), 3U);
    EXPECT_EQ(set.runsOf(0, 1), (std::vector<CellRun>{{2, 3}}));
    EXPECT_EQ(set.runsOf(0, 3), (std::vector<CellRun>{{9, 10}}));
    EXPECT_EQ(set.runsOf(1, 0), (std::vector<CellRun>{{4, 5}}));
    EXPECT_EQ(set.rangeOf(1).begin, 2U);
    EXPECT_EQ(set.rangeOf(1).count, 2U);
}

TEST(CandidateSet, AgreesWithSetsOfCells) {
    Random random(1);
    for (const std::size_t cells : {1UL, 63UL, 64UL, 300UL, 4096UL}) {
        Model model(cells);
        for (int site = 0; site < 60; ++site) model.addRandomSite(random, random() % 12);
        const auto weights = randomWeights(random, cells);
        const WeightSums sums(weights);
        std::vector<std::uint32_t> values(model.set.size());
        model.set.weighAll(sums, values);
        ASSERT_EQ(model.seen.size(), model.set.size());
        for (std::size_t i = 0; i < model.seen.size(); ++i) {
            ASSERT_EQ(model.set.cellsOf(i), model.seen[i]) << cells << ' ' << i;
            ASSERT_EQ(values[i], weightOf(model.seen[i], weights)) << cells << ' ' << i;
            ASSERT_EQ(model.set.weigh(i, sums), values[i]);
            std::size_t count = 0;
            model.set.forEachRun(i, [&](const CellRun& run) { count += run.end - run.first; });
            ASSERT_EQ(count, model.seen[i].count());
            const std::size_t site = model.set.siteOf(i);
            ASSERT_LE(model.set.firstOf(site), i);
            ASSERT_LT(i, model.set.firstOf(site + 1));
        }
    }
}

TEST(CandidateSet, RangesAroundTheEndWithEmptyParts) {
    // Only part 4 of 6 has cells; all parts from 5 on around to 4.
    CandidateSet set(8);
    const std::vector<CandidateSet::PartRange> ranges = {{5, 6}, {5, 5}, {4, 1}};
    set.addSite(ranges, {{{2, 5}}, {0, 0, 0, 0, 0, 1, 1, 1}});
    const std::vector<std::uint32_t> ones(8, 1);
    std::vector<std::uint32_t> values(3);
    set.weighAll(WeightSums(ones), values);
    EXPECT_EQ(values, (std::vector<std::uint32_t>{3, 3 - 3, 3}));
    EXPECT_EQ(set.cellsOf(0).count(), 3U);
    EXPECT_EQ(set.cellsOf(1).count(), 0U);
}

TEST(CandidateSet, LongRunsOnLargeGrids) {
    const std::size_t cells = 10'000'000;  // lengths then have 8 bits
    CandidateSet set(cells);
    CellParts parts{{{0, 10'000'000}}, {0, 1}};
    const CandidateSet::PartRange none;
    set.addSite({&none, 1}, parts);
    parts = {{{9'999'000, 9'999'255}, {9'999'256, 9'999'512}, {9'999'513, 10'000'000}}, {0, 1, 3}};
    const CandidateSet::PartRange one{0, 1};
    set.addSite({&one, 1}, parts);
    EXPECT_EQ(set.cellsOf(0).count(), cells);
    EXPECT_EQ(set.cellsOf(1).count(), 998U);
    std::vector<std::uint32_t> values(2);
    set.weighAll(WeightSums(std::vector<std::uint32_t>(cells, 3)), values);
    EXPECT_EQ(values, (std::vector<std::uint32_t>{30'000'000, 2994}));
}

TEST(CandidateSet, SumsMayWrapAround) {
    // The weights before a run may sum up to more than 2^32, but those of a run or candidate do
    // not.
    const std::vector<std::uint32_t> weights = {4'000'000'000, 4'000'000'000, 5, 7};
    CandidateSet set(4);
    CellSet cells(4);
    cells.set(1);
    cells.set(3);
    set.addSite(cells);
    std::vector<std::uint32_t> values(1);
    set.weighAll(WeightSums(weights), values);
    EXPECT_EQ(values[0], 4'000'000'007);
}

TEST(CandidateSet, ManySitesInManyBlocks) {
    Random random(2);
    Model model(2000);
    std::size_t bytes = 0;
    for (int site = 0; site < 3000; ++site) {
        model.addRandomSite(random, 8);
        ASSERT_GT(model.set.bytes(), bytes);
        bytes = model.set.bytes();
    }
    EXPECT_GT(model.set.runs(), 300'000U);
    const auto weights = randomWeights(random, 2000);
    std::vector<std::uint32_t> values(model.set.size());
    model.set.weighAll(WeightSums(weights), values);
    for (std::size_t i = 0; i < model.seen.size(); ++i)
        ASSERT_EQ(values[i], weightOf(model.seen[i], weights)) << i;
    const CandidateSet copy = model.set;
    std::vector<std::uint32_t> again(copy.size());
    copy.weighAll(WeightSums(weights), again);
    EXPECT_EQ(again, values);
}

}  // namespace candidate_set_test
}  // namespace ispace
