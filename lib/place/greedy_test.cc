// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/greedy.h"

#include <gtest/gtest.h>

#include <random>

namespace ispace {
namespace {

constexpr std::size_t kCells = 60;

std::vector<Candidate> randomCandidates(std::mt19937_64& random, std::size_t count) {
    std::vector<Candidate> candidates(count);
    for (Candidate& candidate : candidates) {
        candidate.seen = CellSet(kCells);
        const std::size_t first = random() % kCells, length = 1 + random() % 20;
        for (std::size_t i = 0; i < length; ++i) candidate.seen.set((first + i) % kCells);
    }
    return candidates;
}

CellSet unionOf(const CellSet& covered, const Candidate& a, const Candidate& b) {
    CellSet all = covered;
    all |= a.seen;
    all |= b.seen;
    return all;
}

TEST(Greedy, TakesTheFirstOfEquals) {
    std::vector<Candidate> candidates(3);
    for (Candidate& candidate : candidates) candidate.seen = CellSet(kCells);
    candidates[1].seen.set(5);
    candidates[2].seen.set(6);
    SilentProgress progress;
    const Placement placement =
        placeGreedily({{&candidates}, {&candidates}}, CellSet(kCells), progress);
    EXPECT_EQ(placement.chosen, (std::vector<std::size_t>{1, 2}));
    EXPECT_EQ(placement.covered.count(), 2U);
    EXPECT_EQ(placement.bound, 2U);
}

TEST(Greedy, WhatIsCoveredAlreadyGainsNothing) {
    std::vector<Candidate> candidates(2);
    for (Candidate& candidate : candidates) candidate.seen = CellSet(kCells);
    for (std::size_t cell = 0; cell < 10; ++cell) candidates[0].seen.set(cell);
    candidates[1].seen.set(20);
    SilentProgress progress;
    const Placement placement = placeGreedily({{&candidates}}, candidates[0].seen, progress);
    EXPECT_EQ(placement.chosen, (std::vector<std::size_t>{1}));
    EXPECT_EQ(placement.covered.count(), 11U);
}

TEST(Greedy, BoundHoldsAndGuaranteeHoldsOnRandomInstances) {
    std::mt19937_64 random(7);
    SilentProgress progress;
    for (int round = 0; round < 200; ++round) {
        const auto wide = randomCandidates(random, 12), narrow = randomCandidates(random, 9);
        CellSet covered(kCells);
        if (round % 2 == 1) covered.set(random() % kCells);
        std::size_t best = 0;
        for (const Candidate& a : wide)
            for (const Candidate& b : narrow) best = std::max(best, unionOf(covered, a, b).count());
        const Placement placement = placeGreedily({{&wide}, {&narrow}}, covered, progress);
        const CellSet chosen =
            unionOf(covered, wide[placement.chosen[0]], narrow[placement.chosen[1]]);
        EXPECT_EQ(placement.covered, chosen);
        EXPECT_GE(placement.bound, best) << "round " << round;
        EXPECT_LE(placement.bound, kCells);
        // One candidate a sensor, sensors in a fixed order: greedy reaches half of the optimum.
        EXPECT_GE(2 * chosen.count(), best) << "round " << round;
    }
}

}  // namespace
}  // namespace ispace
