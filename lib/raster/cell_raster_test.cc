// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "geom/predicates.h"

namespace ispace {
namespace {

const CellFrame kFrame{{-2, -1}, 0.5, 8, 6};

Point2 middle(int column, int row) {
    return {kFrame.origin.x + (column + 0.5) * kFrame.size,
            kFrame.origin.y + (row + 0.5) * kFrame.size};
}

std::vector<std::vector<bool>> cellsOf(const std::vector<CellRun>& runs) {
    std::vector<std::vector<bool>> cells(6, std::vector<bool>(8));
    for (const CellRun& run : runs)
        for (int column = run.first; column <= run.last; ++column)
            cells[static_cast<std::size_t>(run.row)][static_cast<std::size_t>(column)] = true;
    return cells;
}

TEST(CellRaster, ARectangle) {
    const Polygon square{{-1, 0}, {0.5, 0}, {0.5, 1}, {-1, 1}};
    EXPECT_EQ(insideRuns(std::span(&square, 1), kFrame),
              (std::vector<CellRun>{{2, 2, 4}, {3, 2, 4}}));
    EXPECT_TRUE(insideRuns({}, kFrame).empty());
}

TEST(CellRaster, FarCurvesAreCutAtTheFrame) {
    const Polygon all{{-1e6, -1e6}, {1e6, -1e6}, {1e6, 1e6}, {-1e6, 1e6}};
    const std::vector<CellRun> runs = insideRuns(std::span(&all, 1), kFrame);
    ASSERT_EQ(runs.size(), 6U);
    for (const CellRun& run : runs) EXPECT_EQ(run, (CellRun{run.row, 0, 7}));
    const Polygon beside{{50, 0}, {60, 0}, {60, 1}};
    EXPECT_TRUE(insideRuns(std::span(&beside, 1), kFrame).empty());
    std::vector<CellPair> pairs;
    appendCrossings({{-1e6, 100}, {1e6, 100}}, kFrame, pairs);
    EXPECT_EQ(pairs.size(), 8U);  // within its columns, in rows far above
}

TEST(CellRaster, AgreesWithEachMiddle) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> x(-3, 3), y(-2, 3);
    for (int round = 0; round < 500; ++round) {
        std::vector<Polygon> curves(1 + static_cast<std::size_t>(round) % 2);
        for (Polygon& curve : curves)
            for (int i = 0; i < 3 + round % 5; ++i) curve.push_back({x(random), y(random)});
        const auto cells = cellsOf(insideRuns(curves, kFrame));
        for (int row = 0; row < 6; ++row)
            for (int column = 0; column < 8; ++column) {
                const auto inside = std::count_if(curves.begin(), curves.end(), [&](auto& curve) {
                    return locate(curve, middle(column, row)) == Side::Inside;
                });
                EXPECT_EQ(cells[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)],
                          inside % 2 == 1)
                    << round << ": " << column << ", " << row;
            }
    }
}

TEST(CellRaster, CrossingsAreThePairsWithTheSegmentBetween) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> x(-2, 2), y(-1, 2);
    const auto key = [](int c1, int r1, int c2, int r2) {
        return std::array<int, 4>{std::min(c1, c2), std::min(r1, r2), std::max(c1, c2),
                                  std::max(r1, r2)};
    };
    for (int round = 0; round < 500; ++round) {
        const Segment2 segment{{x(random), y(random)}, {x(random), y(random)}};
        std::vector<CellPair> pairs;
        appendCrossings(segment, kFrame, pairs);
        std::set<std::array<int, 4>> found, wanted;
        for (const CellPair& pair : pairs) {
            const int c1 = static_cast<int>(pair.near_column), r1 = static_cast<int>(pair.near_row);
            const int c2 = static_cast<int>(pair.far_column), r2 = static_cast<int>(pair.far_row);
            const Vec2 along = segment.b - segment.a;
            const double t = c1 == c2 ? (middle(c1, r1).x - segment.a.x) / along.x
                                      : (middle(c1, r1).y - segment.a.y) / along.y;
            const Point2 crossing = segment.a + t * along;
            EXPECT_LE(distance(middle(c1, r1), crossing),
                      distance(middle(c2, r2), crossing) + 1e-9);
            if (std::min({c1, r1, c2, r2}) >= 0 && std::max(c1, c2) < 8 && std::max(r1, r2) < 6)
                found.insert(key(c1, r1, c2, r2));
        }
        for (int row = 0; row < 6; ++row)
            for (int column = 0; column < 8; ++column) {
                const Point2 here = middle(column, row);
                if (column < 7 && intersects(segment, {here, middle(column + 1, row)}))
                    wanted.insert(key(column, row, column + 1, row));
                if (row < 5 && intersects(segment, {here, middle(column, row + 1)}))
                    wanted.insert(key(column, row, column, row + 1));
            }
        EXPECT_EQ(found, wanted) << round;
    }
}

TEST(CellRaster, ASegmentThroughMiddlesNamesThem) {
    std::vector<CellPair> pairs;
    appendCrossings({middle(1, 2), middle(3, 2)}, kFrame, pairs);
    EXPECT_EQ(pairs, (std::vector<CellPair>{{1, 2, 1, 2}, {2, 2, 2, 2}, {3, 2, 3, 2}}));
    pairs.clear();
    appendCrossings({{0.01, 0.01}, {0.02, 0.02}}, kFrame, pairs);
    EXPECT_TRUE(pairs.empty());
}

}  // namespace
}  // namespace ispace
