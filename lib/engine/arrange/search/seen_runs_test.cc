// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/cover_sets.h"

#include <gtest/gtest.h>

#include <random>

namespace ispace {
namespace seen_runs_test {

TEST(CellRuns, CommonOnesAndTheirWeightAreThoseOfCells) {
    std::mt19937_64 random(11);
    for (int round = 0; round < 300; ++round) {
        const std::size_t cells = 1 + random() % 60;
        std::vector<char> in_a(cells), in_b(cells);
        std::vector<std::uint32_t> weights(cells);
        for (std::size_t i = 0; i < cells; ++i) {
            in_a[i] = static_cast<char>(i > 0 && random() % 4 != 0 ? in_a[i - 1] : random() % 2);
            in_b[i] = static_cast<char>(i > 0 && random() % 4 != 0 ? in_b[i - 1] : random() % 2);
            weights[i] = static_cast<std::uint32_t>(random() % 100);
        }
        const auto runs_of = [cells](const auto& is_in) {
            CellRuns runs;
            for (std::uint32_t i = 0; i < cells; ++i) {
                if (!is_in(i)) continue;
                if (!runs.empty() && runs.back().end == i)
                    ++runs.back().end;
                else
                    runs.push_back({i, i + 1});
            }
            return runs;
        };
        const CellRuns a = runs_of([&](std::size_t i) { return in_a[i] != 0; });
        const CellRuns b = runs_of([&](std::size_t i) { return in_b[i] != 0; });
        std::int64_t wanted = 0;
        for (std::size_t i = 0; i < cells; ++i)
            if (in_a[i] != 0 && in_b[i] != 0) wanted += weights[i];
        MaskedSums sums(cells);
        sums.assign(b, weights.data());  // is written over
        sums.assign(a, weights.data());
        EXPECT_EQ(sums.of(b), wanted);
        const CellRuns common = commonOf(a, b);
        const CellRuns both = runs_of([&](std::size_t i) { return in_a[i] != 0 && in_b[i] != 0; });
        ASSERT_EQ(common.size(), both.size());
        for (std::size_t i = 0; i < both.size(); ++i) {
            EXPECT_EQ(common[i].first, both[i].first);
            EXPECT_EQ(common[i].end, both[i].end);
        }
    }
}

}  // namespace seen_runs_test
}  // namespace ispace
