// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/planar_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <random>

namespace ispace {
namespace weld_test {

using Indices = std::vector<std::uint32_t>;

TEST(FirstAtPlace, Nothing) { EXPECT_EQ(firstAtPlace({}), Indices()); }

TEST(FirstAtPlace, TheFirstOfEachPlace) {
    const std::vector<FloatPlace> places{{1, 2, 3}, {3, 2, 1}, {1, 2, 3}, {1, 2, 4}, {3, 2, 1}};
    EXPECT_EQ(firstAtPlace(places), (Indices{0, 1, 0, 3, 1}));
}

TEST(FirstAtPlace, MinusZeroIsZeroAndNanIsNoPlace) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<FloatPlace> places{{0, -0.0F, 0},   {-0.0F, 0, -0.0F}, {nan, 0, 0},
                                         {nan, 0, 0},     {infinity, 0, 0},  {-infinity, 0, 0},
                                         {infinity, 0, 0}};
    EXPECT_EQ(firstAtPlace(places), (Indices{0, 0, 2, 3, 4, 5, 4}));
}

TEST(FirstAtPlace, AsAMapFindsThem) {
    std::mt19937 random(1);
    for (const int count : {10, 1000, 100'000})
        for (const int kinds : {2, 12, 60}) {
            // Neighbours on a fine grid, far from the origin: as alike as places of a mesh are.
            std::uniform_int_distribution<int> step(0, kinds);
            const auto part = [&] { return 1000 + static_cast<float>(step(random)) / 1024; };
            std::vector<FloatPlace> places(static_cast<std::size_t>(count));
            for (FloatPlace& place : places) place = {part(), part(), part()};
            std::map<FloatPlace, std::uint32_t> known;
            Indices expected;
            for (std::uint32_t i = 0; i < places.size(); ++i)
                expected.push_back(known.try_emplace(places[i], i).first->second);
            EXPECT_EQ(firstAtPlace(places), expected) << count << " of " << kinds;
        }
}

}  // namespace weld_test
}  // namespace ispace
