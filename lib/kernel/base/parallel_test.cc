// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace ispace {
namespace parallel_test {

TEST(AtOnce, BlocksAreTakenInOrderBeforeTheirMemoryIsUsedAgain) {
    constexpr std::size_t kBlocks = 1000;
    std::array<std::size_t, kBlocksAtOnce> slots{};
    std::vector<std::size_t> taken;
    orderedPipeline(
        kBlocks, [&](std::size_t block) { slots[block % kBlocksAtOnce] = block; },
        [&](std::size_t block) {
            EXPECT_EQ(slots[block % kBlocksAtOnce], block);
            taken.push_back(block);
        });
    std::vector<std::size_t> wanted(kBlocks);
    std::iota(wanted.begin(), wanted.end(), std::size_t{0});
    EXPECT_EQ(taken, wanted);
}

TEST(AtOnce, WithoutBlocksNothingIsMade) {
    const auto fail = [](std::size_t) { FAIL(); };
    orderedPipeline(0, fail, fail);
}

TEST(AtOnce, WhatABlockThrowsArrives) {
    const auto make = [](std::size_t block) {
        if (block == 20) throw std::runtime_error("20");
    };
    EXPECT_THROW(orderedPipeline(100, make, [](std::size_t block) { EXPECT_LT(block, 20U); }),
                 std::runtime_error);
}

TEST(AtOnce, PartsCoverEverythingOnce) {
    for (const bool at_once : {false, true}) {
        for (const std::size_t count : {0U, 1U, 5000U}) {
            std::vector<std::atomic<int>> visits(count);
            parallelChunks(at_once, count, [&](std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i) ++visits[i];
            });
            for (const auto& visit : visits) EXPECT_EQ(visit, 1);
        }
    }
}

}  // namespace parallel_test
}  // namespace ispace
