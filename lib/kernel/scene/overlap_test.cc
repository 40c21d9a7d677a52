// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/overlap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "env/body.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"

namespace ispace {
namespace overlap_test {

const Polygon kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

Polygon moved(Polygon polygon, Vec2 way) {
    for (Point2& p : polygon) p = p + way;
    return polygon;
}

TEST(Overlap, OfSquares) {
    const auto overlap = overlapOf(kSquare, moved(kSquare, {0.75, 0.5}));
    ASSERT_TRUE(overlap);
    EXPECT_DOUBLE_EQ(overlap->depth, 0.25);
    EXPECT_NEAR(overlap->place.x, 0.875, 1e-12);
    EXPECT_NEAR(overlap->place.y, 0.75, 1e-12);
    for (const Vec2 way : {Vec2{1, 0}, {0, 1}, {1, 1}, {-1, 0.3}, {2, 2}, {1 - 1e-9, 0.2}})
        EXPECT_FALSE(overlapOf(kSquare, moved(kSquare, way))) << way.x;
    // One in the other: the way out.
    const Polygon small = rectangle({0.5, 0.7}, 0.2, 0.2, {});
    EXPECT_NEAR(overlapOf(kSquare, small)->depth, 0.4, 1e-12);
    EXPECT_NEAR(overlapOf(small, kSquare)->depth, 0.4, 1e-12);
    EXPECT_NEAR(overlapOf(kSquare, kSquare)->depth, 1, 1e-12);
}

TEST(Overlap, OfLines) {
    const auto through = overlapOf(kSquare, {{0.5, -3}, {0.5, 3}});
    ASSERT_TRUE(through);
    EXPECT_DOUBLE_EQ(through->depth, 0.5);
    EXPECT_NEAR(through->place.x, 0.5, 1e-12);
    EXPECT_NEAR(through->place.y, 0.5, 1e-5);
    EXPECT_FALSE(overlapOf(kSquare, {{1, -3}, {1, 3}})) << "along its edge";
    EXPECT_FALSE(overlapOf(kSquare, {{0, 2}, {2, 0}})) << "through a corner";
    EXPECT_FALSE(overlapOf(kSquare, {{1, 0.5}, {3, 0.5}})) << "up to it";
    EXPECT_TRUE(overlapOf(kSquare, {{0.2, 0.2}, {0.3, 0.3}}));
}

TEST(Overlap, WayBeyondParts) {
    EXPECT_DOUBLE_EQ(penetrationDepth(kSquare, moved(kSquare, {0.75, 0.5}), {1, 0}), 0.25);
    EXPECT_DOUBLE_EQ(penetrationDepth(kSquare, moved(kSquare, {0.75, 0.5}), {-1, 0}), 1.75);
    EXPECT_LT(penetrationDepth(kSquare, moved(kSquare, {3, 0}), {1, 0}), 0);
}

TEST(Overlap, AgreesWithTheAreaInCommon) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-1, 1), extent(0.2, 1.5), turn(0, 360);
    int overlapping = 0;
    for (int run = 0; run < 500; ++run) {
        const auto any = [&] {
            const Point2 center{place(random), place(random)};
            const double length = extent(random), width = extent(random);
            const Angle heading = Angle::degrees(turn(random));
            if (random() % 2 == 0) return rectangle(center, length, width, heading);
            Polygon polygon;
            for (int k = 0; k < 12; ++k) {
                const Vec2 v = unitVector(heading + Angle::degrees(30.0 * k));
                polygon.push_back(center + Vec2{length / 2 * v.x, width / 2 * v.y});
            }
            return polygon;
        };
        const Polygon a = any(), b = any();
        const auto found = overlapOf(a, b);
        const double common = signedArea(a) - totalArea(difference({a, {}}, std::span(&b, 1)));
        EXPECT_EQ(found.has_value(), common > 1e-9) << common;
        if (!found) continue;
        ++overlapping;
        EXPECT_EQ(locate(a, found->place), Side::Inside);
        EXPECT_EQ(locate(b, found->place), Side::Inside);
        // As far as told in some direction, they are apart.
        bool apart = false;
        for (int k = 0; k < 360 && !apart; ++k) {
            const Vec2 way = (found->depth * 1.001) * unitVector(Angle::degrees(1.0 * k));
            apart = !overlapOf(a, moved(b, way));
        }
        EXPECT_TRUE(apart) << found->depth;
        EXPECT_EQ(overlapOf(b, a).has_value(), true);
    }
    EXPECT_GT(overlapping, 100);
    EXPECT_LT(overlapping, 450);
}

TEST(Overlap, PlaceWithinAnyPolygon) {
    // A ring, its hole reached by a seam.
    const Polygon ring{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 1}, {1, 1},
                       {1, 3}, {3, 3}, {3, 1}, {1, 1}, {0, 1}};
    EXPECT_TRUE(placeWithin({{-1, 0.5}, {5, 0.5}}, ring));
    EXPECT_FALSE(placeWithin({{1.5, 2}, {2.5, 2}}, ring)) << "in the hole";
    EXPECT_TRUE(placeWithin({{1.5, 2}, {3.5, 2}}, ring));
    EXPECT_FALSE(placeWithin({{-1, 0}, {5, 0}}, ring)) << "along its edge";
    EXPECT_FALSE(placeWithin({{1, -1}, {1, 0}}, ring));
    EXPECT_TRUE(placeWithin({{3.2, 3.2}, {3.3, 3.4}}, ring));
    EXPECT_FALSE(placeWithin({{5, 5}, {6, 6}}, ring));
    EXPECT_FALSE(placeWithin({{5, 5}, {5, 5}}, ring));
}

TEST(Overlap, SharedPlaceOfCuts) {
    Slice cut;
    cut.solids = {kSquare};
    cut.sheets = {{{3, 0}, {3, 2}}};
    EXPECT_TRUE(sharedPlace(cut, moved(kSquare, {0.5, 0.5})));
    EXPECT_FALSE(sharedPlace(cut, moved(kSquare, {1, 0})));
    EXPECT_TRUE(sharedPlace(cut, rectangle({0.5, 0.5}, 0.1, 0.1, {}))) << "wholly in it";
    EXPECT_TRUE(sharedPlace(cut, rectangle({0.5, 0.5}, 5, 5, {}))) << "around it";
    EXPECT_TRUE(sharedPlace(cut, kSquare));
    EXPECT_TRUE(sharedPlace(cut, rectangle({3, 1}, 0.5, 0.5, {}))) << "a sheet runs through it";
    EXPECT_FALSE(sharedPlace(cut, rectangle({3.25, 1}, 0.5, 0.5, {})));
    EXPECT_TRUE(sharedPlace(cut, Polygon{{0.5, -1}, {0.5, 2}}));
    EXPECT_FALSE(sharedPlace(cut, Polygon{{1, -1}, {1, 2}}));
    Slice other;
    const auto with = [&](Polygon solid) {
        other.solids = {std::move(solid)};
        return sharedPlace(cut, other).has_value();
    };
    EXPECT_TRUE(with(kSquare));
    EXPECT_TRUE(with(moved(kSquare, {0.5, 0})));
    EXPECT_FALSE(with(moved(kSquare, {1, 0})));
    EXPECT_TRUE(with(rectangle({0.5, 0.5}, 0.1, 0.1, {})));
    EXPECT_TRUE(with(rectangle({0.5, 0.5}, 1.1, 1.1, {})));
    EXPECT_TRUE(with(rectangle({3, 1}, 0.1, 0.1, {}))) << "the sheet";
    EXPECT_FALSE(with(rectangle({6, 1}, 0.1, 0.1, {})));
}

// 220 000 corners each: a time that grows with their product would be minutes.
TEST(Overlap, OfRoundThingsAsLargeAsTowns) {
    const Polygon a = inscribedIn(Ellipse({0, 0}, 1e6, 1e6, {}));
    const Polygon b = inscribedIn(Ellipse({8e5, 0}, 1e6, 1e6, {}));
    const auto overlap = overlapOf(a, b);
    ASSERT_TRUE(overlap);
    EXPECT_NEAR(overlap->depth, 2e5, 1);
    EXPECT_NEAR(overlap->place.x, 4e5, 1);
    EXPECT_NEAR(overlap->place.y, 0, 1);
    EXPECT_NEAR(overlapOf(a, {{4e5, -1e6}, {4e5, 1e6}})->depth, 1e5, 1);
}

}  // namespace overlap_test
}  // namespace ispace
