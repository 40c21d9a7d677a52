// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/sheet_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "geom/predicates.h"

namespace ispace {
namespace sheet_index_test {

/// Places on sheets, at their ends, beside them and anywhere, each told as by all sheets in turn.
TEST(SheetIndex, HoldsWhatASearchOfAllSheetsHolds) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(-14, 14), share(0, 1);
    for (const std::size_t count : {1U, 5U, 300U}) {
        std::vector<Segment2> star, hatch;
        for (std::size_t i = 0; i < count; ++i) {
            const double turn = 2.399963 * static_cast<double>(i);
            star.push_back({{0, 0}, {14 * std::cos(turn), 14 * std::sin(turn)}});
            const double x = anywhere(random);
            hatch.push_back({{x, -14}, {x, 14}});
        }
        for (const std::vector<Segment2>& sheets : {star, hatch}) {
            const SheetIndex index(sheets);
            const auto agree = [&](Point2 p) {
                EXPECT_EQ(index.holds(p), std::any_of(sheets.begin(), sheets.end(),
                                                      [p](const Segment2& s) {
                                                          return intersects(s, {p, p});
                                                      }))
                    << p.x << ' ' << p.y;
            };
            for (const auto& [a, b] : sheets)
                for (const Point2 p : {a, b, a + share(random) * (b - a), a + 0.5 * (b - a),
                                       Point2{std::nextafter(b.x, 20.0), b.y}})
                    agree(p);
            for (int i = 0; i < 2000; ++i) agree({anywhere(random), anywhere(random)});
        }
    }
    EXPECT_FALSE(SheetIndex({}).holds({0, 0}));
}

}  // namespace sheet_index_test
}  // namespace ispace
