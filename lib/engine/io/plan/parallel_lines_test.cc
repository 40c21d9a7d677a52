// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/parallel_lines.h"

#include <gtest/gtest.h>

#include <vector>

namespace ispace {
namespace parallel_lines_test {

/// Both sides of a wall of 0.2 m, each drawn again and again.
std::vector<Segment2> wallDrawn(int times) {
    std::vector<Segment2> lines;
    for (int i = 0; i < times; ++i) {
        lines.push_back({{0, 0}, {5, 0}});
        lines.push_back({{5, 0.2}, {0, 0.2}});
    }
    return lines;
}

TEST(ParallelLines, CopiesOfALineCountOnce) {
    constexpr std::size_t kFew = 10'000;  // units; each pair of copies would take 250 000
    const std::vector<Segment2> lines = wallDrawn(2000);
    ParallelLines parallels(lines);
    Budget work(0, {.max = kFew});
    for (const Segment2& line : lines) {
        const auto other = parallels.otherSide(line, 1, work);
        ASSERT_TRUE(other);
        EXPECT_DOUBLE_EQ(*other, 0.2);
    }
}

}  // namespace parallel_lines_test
}  // namespace ispace
