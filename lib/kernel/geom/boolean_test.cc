// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/arrangement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/error.h"
#include "geom/curve.h"
#include "geom/planar_map.h"
#include "support/test_curves.h"

namespace ispace {

namespace boolean_test {

Polygon reversed(Polygon polygon) {
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

const Region kRoom{test::box(0, 0, 8, 6), {}};

TEST(Difference, withoutSolidsIsTheRegion) {
    const auto pieces = difference(kRoom, {});
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces[0].outline, kRoom.outline);
    EXPECT_TRUE(difference(Region{}, {}).empty());
    EXPECT_TRUE(difference(Region{}, std::vector<Polygon>{test::box(0, 0, 1, 1)}).empty());
    EXPECT_EQ(totalArea({}), 0);
}

TEST(Difference, solidInside) {
    for (const Polygon& solid : {test::box(2, 2, 4, 4), reversed(test::box(2, 2, 4, 4))}) {
        const auto pieces = difference(kRoom, std::vector<Polygon>{solid});
        ASSERT_EQ(pieces.size(), 1U);
        EXPECT_EQ(pieces[0].outline, kRoom.outline);
        ASSERT_EQ(pieces[0].holes.size(), 1U);
        EXPECT_EQ(signedArea(pieces[0].holes[0]), -4);
    }
}

TEST(Difference, overlappingTouchingNestedDoubledSolids) {
    const std::vector<Polygon> solids{
        test::box(1, 1, 3, 3),     test::box(1, 1, 3, 3),            // twice the same
        test::box(2, 2, 4, 4),                                       // overlaps
        test::box(4, 2, 5, 4),                                       // shares an edge
        test::box(5, 4, 6, 5),                                       // touches at a corner
        test::box(1.5, 1.5, 2, 2), reversed(test::box(1, 1, 2, 2)),  // nested
        test::box(-5, -5, -1, -1),                                   // outside
    };
    const auto pieces = difference(kRoom, solids);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(totalArea(pieces), 48 - (4 + 4 - 1 + 2 + 1));
}

TEST(Difference, thousandsOfEqualSolids) {
    const std::vector<Polygon> solids(5000, test::box(2, 2, 4, 4));
    EXPECT_EQ(totalArea(difference(kRoom, solids)), 44);
}

TEST(Difference, solidAcrossTheRoomDividesIt) {
    const auto pieces = difference(kRoom, std::vector<Polygon>{test::box(3, -1, 5, 7)});
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_EQ(pieces[0].outline, test::box(0, 0, 3, 6));
    EXPECT_EQ(pieces[1].outline, test::box(5, 0, 8, 6));
    EXPECT_EQ(difference(kRoom, std::vector<Polygon>{test::box(3, 0, 5, 6)}).size(), 2U) << "flush";
}

TEST(Difference, solidAlongAWallCutsTheOutline) {
    const auto pieces = difference(kRoom, std::vector<Polygon>{test::box(2, 0, 4, 1)});
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces[0].outline,
              (Polygon{{0, 0}, {2, 0}, {2, 1}, {4, 1}, {4, 0}, {8, 0}, {8, 6}, {0, 6}}));
}

TEST(Difference, everythingCovered) {
    EXPECT_TRUE(difference(kRoom, std::vector<Polygon>{test::box(-1, -1, 9, 9)}).empty());
    EXPECT_TRUE(difference(kRoom, std::vector<Polygon>{kRoom.outline}).empty());
    EXPECT_TRUE(
        difference(kRoom, std::vector<Polygon>{test::box(0, 0, 4, 6), test::box(4, 0, 8, 6)})
            .empty());
}

TEST(Difference, ringOfSolidsKeepsItsMiddle) {
    const std::vector<Polygon> ring{test::box(2, 2, 6, 3), test::box(2, 4, 6, 5),
                                    test::box(2, 2, 3, 5), test::box(5, 2, 6, 5)};
    const auto pieces = difference(kRoom, ring);
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_EQ(pieces[0].area(), 48 - 12);
    EXPECT_EQ(pieces[1].area(), 2);
}

TEST(Difference, holesThatTouchTheOutlineAndSolids) {
    // A hole with one corner on the outline, and solids on that corner, along the hole and over it.
    const Region region{
        test::box(0, 0, 8, 6),
        {reversed({{0, 3}, {1, 2}, {2, 3}, {1, 4}}), reversed(test::box(4, 2, 6, 4))}};
    EXPECT_EQ(totalArea(difference(region, {})), 48 - 2 - 4);
    EXPECT_EQ(totalArea(difference(region, std::vector<Polygon>{test::box(6, 2, 7, 4)})),
              48 - 2 - 6);
    EXPECT_EQ(totalArea(difference(region, std::vector<Polygon>{test::box(5, 3, 7, 5)})),
              48 - 6 - 3);
    EXPECT_EQ(totalArea(difference(region, std::vector<Polygon>{test::box(0, 2, 2, 4)})),
              48 - 4 - 4);
    EXPECT_EQ(totalArea(difference(region, std::vector<Polygon>{test::box(4, 2, 6, 4)})),
              48 - 2 - 4);
}

TEST(Difference, pinchedRegion) {
    // Two squares that hang together at (4, 3) only are two pieces of floor.
    const Region eight{{{0, 0}, {4, 0}, {4, 3}, {8, 3}, {8, 6}, {4, 6}, {4, 3}, {0, 3}}, {}};
    EXPECT_EQ(difference(eight, {}).size(), 2U);
    EXPECT_DOUBLE_EQ(
        totalArea(difference(eight, std::vector<Polygon>{test::box(3.5, 2.5, 4.5, 3.5)})), 23.5);
}

TEST(Difference, agreesWithPointsOnRandomSolids) {
    std::mt19937_64 random(10);
    std::uniform_real_distribution<double> coordinate(-10, 10);
    for (int round = 0; round < 30; ++round) {
        const Region region{test::star(random, 30, 10), {}};
        std::vector<Polygon> solids;
        for (int i = 0; i < 12; ++i) {
            Polygon solid = test::star(random, 12, 3);
            const Vec2 move{coordinate(random), coordinate(random)};
            for (Point2& p : solid) p = p + move;
            solids.push_back(solid);
        }
        const auto pieces = difference(region, solids);
        for (int i = 0; i < 500; ++i) {
            const Point2 p{coordinate(random), coordinate(random)};
            bool wanted = region.locate(p) == Side::Inside;
            for (const Polygon& solid : solids)
                wanted = wanted && locate(solid, p) == Side::Outside;
            const auto holds = [&](const Region& piece) { return piece.locate(p) == Side::Inside; };
            EXPECT_EQ(std::count_if(pieces.begin(), pieces.end(), holds), wanted ? 1 : 0);
        }
        for (const Region& piece : pieces) {
            EXPECT_GT(piece.area(), 0);
            EXPECT_GT(signedArea(piece.outline), 0);
        }
    }
}

TEST(Difference, agreesWithPixelsOnRaggedMaps) {
    std::mt19937_64 random(11);
    for (int round = 0; round < 10; ++round) {
        test::PixelMap map(random, 60, 60, 0.75);
        std::vector<Polygon> solids;
        test::PixelMap left = map;
        for (int i = 0; i < 40; ++i) {
            const int x = int(random() % 58), y = int(random() % 58), w = 1 + int(random() % 4),
                      h = 1 + int(random() % 4);
            solids.push_back(test::box(x, y, x + w, y + h));
            for (int py = y; py < std::min(60, y + h); ++py) {
                for (int px = x; px < std::min(60, x + w); ++px)
                    left.free[static_cast<std::size_t>(py * 60 + px)] = false;
            }
        }
        std::vector<Region> pieces;
        for (const Region& face : boundedFaces(weld(map.boundary()))) {
            const Point2 p = interiorPoint(face);
            if (!map.at(int(std::floor(p.x)), int(std::floor(p.y)))) continue;
            for (Region& piece : difference(face, solids)) pieces.push_back(std::move(piece));
        }
        EXPECT_DOUBLE_EQ(totalArea(pieces), double(left.freeCount()));
        EXPECT_EQ(int(pieces.size()), left.pieces());
    }
}

TEST(Difference, manyRoundSolids) {
    std::mt19937_64 random(12);
    std::uniform_real_distribution<double> coordinate(0, 60);
    const Region hall{test::box(0, 0, 60, 60), {}};
    std::vector<Polygon> solids;
    for (int i = 0; i < 200; ++i)
        solids.push_back(test::circle({coordinate(random), coordinate(random)}, 1, 140));
    const auto pieces = difference(hall, solids);
    for (int i = 0; i < 2000; ++i) {
        const Point2 p{coordinate(random), coordinate(random)};
        const bool blocked = std::any_of(solids.begin(), solids.end(), [&](const Polygon& solid) {
            return locate(solid, p) != Side::Outside;
        });
        const bool free = std::any_of(pieces.begin(), pieces.end(), [&](const Region& piece) {
            return piece.locate(p) == Side::Inside;
        });
        EXPECT_NE(free, blocked);
    }
}

TEST(Unite, solidsThatOverlapTouchAndStandApart) {
    EXPECT_TRUE(unite({}).empty());
    const auto pieces = unite(std::vector<Polygon>{
        test::box(0, 0, 2, 2), reversed(test::box(1, 1, 3, 3)), test::box(3, 1, 4, 3),
        test::box(0.5, 0.5, 1, 1), test::box(6, 0, 7, 1)});
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_EQ(totalArea(pieces), 4 + 4 - 1 + 2 + 1);
    for (const Region& piece : pieces) EXPECT_TRUE(piece.holes.empty());
}

TEST(Unite, aRingHasAHole) {
    const auto pieces = unite(std::vector<Polygon>{test::box(0, 0, 5, 1), test::box(0, 4, 5, 5),
                                                   test::box(0, 0, 1, 5), test::box(4, 0, 5, 5)});
    ASSERT_EQ(pieces.size(), 1U);
    ASSERT_EQ(pieces[0].holes.size(), 1U);
    EXPECT_EQ(signedArea(pieces[0].holes[0]), -9);
    EXPECT_EQ(pieces[0].area(), 16);
}

TEST(Difference, solidsThatStandClearAreHolesOfTheirPiece) {
    // A wall of solids cuts the room in two; boxes stand clear on both sides, in a hole and
    // outside.
    const Region room{test::box(0, 0, 10, 10), {{{1, 1}, {1, 3}, {3, 3}, {3, 1}}}};
    std::vector<Polygon> solids{test::box(4.5, -1, 5.5, 6), test::box(4.5, 5, 5.5, 11)};
    for (const Point2 at : {Point2{2, 8}, {3, 5}, {8, 2}, {8, 8}, {1.5, 1.5}, {12, 5}, {8, -3}})
        solids.push_back(test::box(at.x, at.y, at.x + 0.5, at.y + 0.5));
    const std::vector<Region> pieces = difference(room, solids);
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_NEAR(totalArea(pieces), 90 - 4 - 4 * 0.25, 1e-12);
    for (const Region& piece : pieces) {
        for (const Polygon& hole : piece.holes) {
            EXPECT_LT(signedArea(hole), 0);
            EXPECT_EQ(locate(piece.outline, hole.front()), Side::Inside);
        }
    }
    EXPECT_EQ(pieces[0].holes.size() + pieces[1].holes.size(), 5U);
}

TEST(Difference, isTheSameWithAndWithoutNeighbours) {
    // Solids at random, some clear of all others: area by cells.
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-1, 11), size(0.05, 0.9);
    const Region room{test::box(0, 0, 10, 10), {}};
    for (int run = 0; run < 30; ++run) {
        std::vector<Polygon> solids;
        for (int i = 0; i < 5 + 3 * run; ++i) {
            const Point2 at{place(random), place(random)};
            solids.push_back(test::box(at.x, at.y, at.x + size(random), at.y + size(random)));
        }
        const std::vector<Region> pieces = difference(room, solids);
        for (int k = 0; k < 400; ++k) {
            const Point2 p{place(random), place(random)};
            const bool covered = std::any_of(solids.begin(), solids.end(), [&](const Polygon& s) {
                return locate(s, p) != Side::Outside;
            });
            const bool wanted = room.locate(p) == Side::Inside && !covered;
            const auto holds = [&](const Region& r) { return r.locate(p) == Side::Inside; };
            EXPECT_EQ(std::count_if(pieces.begin(), pieces.end(), holds), wanted ? 1 : 0);
        }
    }
}

// An arrangement of them would take gigabytes.
TEST(Difference, boundsCrossings) {
    const auto heap = [](int count) {
        std::vector<Polygon> solids;
        for (int i = 0; i < count; ++i) {
            const double a = i, x = 0.001 * (i * 7919 % count);
            const Vec2 way{std::cos(a), std::sin(a)}, side = perpendicular(way);
            const Point2 low{x, 0.0005 * i};
            solids.push_back({low, low + way, low + way + side, low + side});
        }
        return solids;
    };
    try {
        difference(kRoom, heap(4000));
        FAIL() << "took them";
    } catch (const FormatError& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("at most 500000 can be"), std::string::npos) << what;
    }
    EXPECT_THROW(unite(heap(4000)), FormatError);
    EXPECT_FALSE(difference(kRoom, heap(150)).empty());
}

}  // namespace boolean_test

namespace boolean_test {

double reachOf(const Polygon& polygon, Vec2 direction) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Point2 p : polygon) most = std::max(most, dot(p - Point2(), direction));
    return most;
}

Vec2 towards(double angle) { return {std::cos(angle), std::sin(angle)}; }

Polygon round(Point2 center, double length, double width, double heading) {
    return inscribedIn(Ellipse(center, length, width, Angle::radians(heading)));
}

TEST(ConvexPair, ReachesAsFarAsTheFurthestCorner) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int k = 0; k < 60; ++k) {
        const double scale = std::pow(10, 4 * uniform(random));
        const Polygon polygon = round({scale * uniform(random), 3 * scale}, scale,
                                      scale * std::pow(10, -2 + 2 * uniform(random)), k);
        Caliper turning(polygon), jumping(polygon), back(polygon);
        for (int i = 0; i < 200; ++i) {
            const double turn = i * std::numbers::pi / 100;
            for (const auto& [caliper, angle] :
                 {std::pair(&turning, turn), {&back, -turn}, {&jumping, 9 * uniform(random)}})
                EXPECT_NEAR(caliper->reach(towards(angle)), reachOf(polygon, towards(angle)),
                            1e-13 * scale);
        }
    }
}

TEST(ConvexPair, ReachesOverDoubledAndStraightCorners) {
    const Polygon polygon{{0, 0}, {0, 0}, {1, 0}, {2, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
    const Polygon line{{0, 0}, {3, 1}};
    for (const Polygon& shape : {polygon, line, Polygon{{1, 2}}}) {
        Caliper caliper(shape);
        for (int i = 0; i < 50; ++i)
            EXPECT_NEAR(caliper.reach(towards(i)), reachOf(shape, towards(i)), 1e-15) << i;
        Caliper axes(shape);
        for (const Vec2 axis : {Vec2{0, -1}, {1, 0}, {0, 1}, {-1, 0}, {1, 0}})
            EXPECT_EQ(axes.reach(axis), reachOf(shape, axis));
    }
}

TEST(ConvexPair, SharesWhatTheOverlayShares) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int k = 0; k < 100; ++k) {
        const Polygon a =
            round({uniform(random), uniform(random)}, 1.5, 1 + 0.4 * uniform(random), k);
        const Polygon b =
            k % 2 == 0 ? round({uniform(random), uniform(random)}, 2, 0.3, 7 * uniform(random))
                       : Polygon{{-1, -1}, {0.4 * uniform(random), -0.8}, {1, 1}, {-1, 1}};
        const Polygon shared = sharedByConvex(a, b);
        const Polygon both[] = {a, b};
        const double wanted = signedArea(a) + signedArea(b) - totalArea(unite(both));
        EXPECT_NEAR(shared.empty() ? 0 : signedArea(shared), wanted, 1e-9) << k;
    }
    const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    EXPECT_EQ(signedArea(sharedByConvex(square, square)), 1);
    EXPECT_TRUE(sharedByConvex(square, {{5, 5}, {6, 5}, {6, 6}}).empty());
    EXPECT_TRUE(sharedByConvex({}, square).empty());
}

// 220 000 corners each, of which each crosses one of the other: quadratic time would be an hour.
TEST(ConvexPair, ManyCorners) {
    const Polygon a = round({0, 0}, 1e6, 1e6, 0), b = round({1e5, 0}, 1e6, 1e6, 0.1);
    ASSERT_GT(a.size(), 200'000U);
    const double r = 5e5, d = 1e5;
    const double lens = 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d);
    EXPECT_NEAR(signedArea(sharedByConvex(a, b)) / lens, 1, 1e-9);
}

}  // namespace boolean_test

}  // namespace ispace
