// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/whole_units.h"

#include <gtest/gtest.h>

#include "base/error.h"

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
    EXPECT_THROW(wholeUnits({3e9, 3e9}), UsageError);
}

}  // namespace
}  // namespace ispace
