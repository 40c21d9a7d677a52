// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/cell_set.h"

#include <gtest/gtest.h>

#include <random>

namespace ispace {
namespace cell_set_test {

TEST(CellSet, AgreesWithPlainBits) {
    std::mt19937_64 random(7);
    for (const std::size_t size : {0UL, 1UL, 63UL, 64UL, 65UL, 1000UL}) {
        std::vector<bool> a(size), b(size);
        CellSet x(size), y(size);
        for (std::size_t i = 0; i < size; ++i) {
            if (random() % 2 != 0) a[i] = true, x.set(i);
            if (random() % 3 == 0) b[i] = true, y.set(i);
        }
        CellSet both = x, either = x, only = x;
        both &= y;
        either |= y;
        only -= y;
        std::size_t count = 0, common = 0;
        std::vector<std::size_t> listed, expected;
        x.forEach([&listed](std::size_t i) { listed.push_back(i); });
        for (std::size_t i = 0; i < size; ++i) {
            EXPECT_EQ(x.test(i), a[i]);
            EXPECT_EQ(both.test(i), a[i] && b[i]);
            EXPECT_EQ(either.test(i), a[i] || b[i]);
            EXPECT_EQ(only.test(i), a[i] && !b[i]);
            count += a[i] ? 1 : 0;
            common += a[i] && b[i] ? 1 : 0;
            if (a[i]) expected.push_back(i);
        }
        EXPECT_EQ(x.size(), size);
        EXPECT_EQ(x.count(), count);
        EXPECT_EQ(countCommon(x, y), common);
        EXPECT_EQ(listed, expected);
        EXPECT_EQ(x == y, a == b);
    }
}

TEST(CellSet, CroppedSetsAreEqual) {
    std::mt19937_64 random(7);
    constexpr std::size_t kSize = 700;
    for (int round = 0; round < 200; ++round) {
        const auto some = [&random] {
            CellSet set(kSize);
            const std::size_t low = random() % kSize, high = low + random() % (kSize - low);
            for (std::size_t i = low; i < high; ++i)
                if (random() % 2 == 0) set.set(i);
            return set;
        };
        const CellSet x = some(), y = some();
        CellSet a = x, b = y;
        if (round % 3 != 1) a.crop();
        if (round % 3 != 2) b.crop();
        EXPECT_EQ(a, x);
        EXPECT_EQ(a.count(), x.count());
        EXPECT_EQ(a.empty(), x.empty());
        EXPECT_EQ(a == b, x == y);
        EXPECT_EQ(countCommon(a, b), countCommon(x, y));
        EXPECT_EQ(partOf(a).runs, partOf(x).runs);
        CellSet both = a, either = a, only = a, more = a, fewer = a, marked = a;
        both &= b;
        either |= b;
        only -= b;
        const std::size_t cell = random() % kSize, first = random() % (kSize - 64);
        const std::uint64_t bits = random();
        more.set(cell);
        fewer.reset(cell);
        marked.addBits(first, bits);
        for (std::size_t i = 0; i < kSize; ++i) {
            const bool in_x = x.test(i), in_y = y.test(i);
            EXPECT_EQ(a.test(i), in_x);
            EXPECT_EQ(both.test(i), in_x && in_y);
            EXPECT_EQ(either.test(i), in_x || in_y);
            EXPECT_EQ(only.test(i), in_x && !in_y);
            EXPECT_EQ(more.test(i), in_x || i == cell);
            EXPECT_EQ(fewer.test(i), in_x && i != cell);
            const bool is_marked =
                i >= first && i < first + 64 && ((bits >> (i - first)) & 1U) != 0;
            EXPECT_EQ(marked.test(i), in_x || is_marked);
        }
    }
}

TEST(PartOf, RunsOfASet) {
    CellSet set(200);
    for (const std::size_t cell : {0U, 1U, 2U, 63U, 64U, 65U, 130U, 199U}) set.set(cell);
    const CellParts parts = partOf(set);
    EXPECT_EQ(parts.runs, (std::vector<CellRun>{{0, 3}, {63, 66}, {130, 131}, {199, 200}}));
    EXPECT_EQ(parts.first, (std::vector<std::uint32_t>{0, 4}));
    EXPECT_EQ(partOf(CellSet(10)).size(), 1U);
}

}  // namespace cell_set_test
}  // namespace ispace
