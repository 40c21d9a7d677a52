// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/near_segments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "geom/predicates.h"

namespace ispace {
namespace {

TEST(NearSegments, FindsWhatAllDistancesFind) {
    std::mt19937_64 random(7);
    const auto coordinate = [&] { return static_cast<double>(random() % 1000) / 100; };
    std::vector<Segment2> segments{{{0, 0}, {90000, 1}}};
    for (int i = 0; i < 300; ++i)
        segments.push_back({{coordinate(), coordinate()}, {coordinate(), coordinate()}});
    const NearSegments search(segments);
    for (int i = 0; i < 200; ++i) {
        const Point2 p{coordinate(), coordinate()};
        const std::vector<std::size_t> near = search.near(p, 0.3);
        EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
        for (std::size_t k = 0; k < segments.size(); ++k) {
            if (distance(p, segments[k]) > 0.3) continue;
            EXPECT_TRUE(std::binary_search(near.begin(), near.end(), k));
        }
    }
    EXPECT_EQ(search.near(Point2{50000, 5}, 1), std::vector<std::size_t>{});
    EXPECT_TRUE(NearSegments({}).near(Point2{0, 0}, 1).empty());
}

}  // namespace
}  // namespace ispace
