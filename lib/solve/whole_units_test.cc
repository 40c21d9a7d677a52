// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/whole_units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace ispace {
namespace {

using Units = std::vector<std::uint32_t>;

TEST(WholeUnits, WholeWeightsStay) {
    EXPECT_EQ(wholeUnits({0, 1, 20}), (Units{0, 1, 20}));
    EXPECT_EQ(wholeUnits({}), Units());
}

TEST(WholeUnits, DecimalsAreScaledTogether) {
    EXPECT_EQ(wholeUnits({1, 0.5, 2.25}), (Units{100, 50, 225}));
    EXPECT_EQ(wholeUnits({0.1, 0.3}), (Units{1, 3})) << "as written, not as stored";
}

TEST(WholeUnits, SumsStayBelowTheLimit) {
    const std::vector<double> many(1000000, 1.0 / 3);
    std::uint64_t sum = 0;
    for (const std::uint32_t unit : wholeUnits(many)) sum += unit;
    EXPECT_LT(sum, std::uint64_t{1} << 32U);
    EXPECT_GT(sum, 300'000'000U) << "and are not coarser than they must be";
}

/// The scale of before, which results of ordinary weights were made with.
Units unitsOfSixDecimals(const std::vector<double>& worth) {
    const double sum = std::accumulate(worth.begin(), worth.end(), 0.0);
    double scale = 1;
    const auto is_whole = [&](double w) {
        return std::abs(w * scale - std::round(w * scale)) < 1e-9 * scale;
    };
    while (scale < 1e6 && !std::all_of(worth.begin(), worth.end(), is_whole) &&
           sum * scale * 10 < 4e9)
        scale *= 10;
    Units units;
    for (const double w : worth)
        units.push_back(static_cast<std::uint32_t>(std::llround(w * scale)));
    return units;
}

TEST(WholeUnits, OrdinaryWeightsHaveSixDecimals) {
    std::mt19937_64 random(3);
    const double ordinary[] = {0,   1,    2,     5,       0.5,     1.0 / 3, 0.1,  2.0 / 3,
                               0.2, 0.25, 0.125, 1.0 / 7, 0.12345, 10,      1000, 12.5};
    std::uniform_int_distribution<std::size_t> pick(0, std::size(ordinary) - 1);
    for (const std::size_t size : {1, 2, 3, 100, 10000, 40000})
        for (int i = 0; i < 30; ++i) {
            const double some[] = {ordinary[pick(random)], ordinary[pick(random)], 1};
            std::vector<double> worth;
            worth.reserve(size);
            for (std::size_t k = 0; k < size; ++k) worth.push_back(some[random() % 3]);
            ASSERT_EQ(wholeUnits(worth), unitsOfSixDecimals(worth)) << size << ' ' << i;
        }
}

TEST(WholeUnits, SmallWeightsCountByTheLargest) {
    EXPECT_EQ(wholeUnits({3.3333e-7, 0}), (Units{33333, 0}));
    EXPECT_EQ(wholeUnits({3e-7, 1e-7, 0}), (Units{3, 1, 0}));
    EXPECT_EQ(wholeUnits({2e-10}), (Units{2}));
    EXPECT_EQ(wholeUnits({1e-8 / 3}), (Units{333333})) << "six digits";
    // Too small to be told apart from nothing beside the large one; but it is not nothing.
    EXPECT_EQ(wholeUnits({1, 1e-12}), (Units{1000000, 1}));
    const double least = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(wholeUnits({least, 0}), (Units{1, 0}));
}

TEST(WholeUnits, LargeWeightsAreScaledDown) {
    EXPECT_EQ(wholeUnits({3e9, 1e9}), (Units{3000000000U, 1000000000U})) << "the sum fits";
    EXPECT_EQ(wholeUnits({6e9, 2e9}), (Units{3000000000U, 1000000000U}));
    std::vector<double> many(10000, 1e6);
    EXPECT_EQ(wholeUnits(many), Units(10000, 400000));
    // What counts little still counts where something else counts a million times as much.
    many.resize(1000000, 1);
    std::fill_n(many.begin(), 500000, 1e6);
    const Units units = wholeUnits(many);
    EXPECT_EQ(units.front(), 8000U);
    EXPECT_EQ(units.back(), 1U);
    EXPECT_LT(std::accumulate(units.begin(), units.end(), std::uint64_t{0}),
              std::uint64_t{1} << 32U);
}

}  // namespace
}  // namespace ispace
