// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/planar_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "support/test_curves.h"

namespace ispace {
namespace planar_map_test {

std::vector<Region> facesOf(const std::vector<Segment2>& lines) {
    return boundedFaces(weld(lines));
}

void append(std::vector<Segment2>& lines, const Polygon& curve) {
    forEachEdge(curve, [&](const Segment2& e) { lines.push_back(e); });
}

TEST(Weld, leavesCleanLinesAlone) {
    const auto lines = test::edgesOf(test::box(0, 0, 8, 6));
    const WeldedLines welded = weld(lines);
    EXPECT_EQ(welded.pieces, lines);
    EXPECT_EQ(welded.source, (std::vector<std::size_t>{0, 1, 2, 3}));
    EXPECT_TRUE(weld({}).pieces.empty());
}

TEST(Weld, dropsWhatHasNoLength) {
    const std::vector<Segment2> lines{{{0, 0}, {0, 0}}, {{1, 0}, {2, 0}}, {{5, 5}, {5 + 5e-7, 5}}};
    const WeldedLines welded = weld(lines);
    EXPECT_EQ(welded.pieces, (std::vector<Segment2>{{{1, 0}, {2, 0}}}));
    EXPECT_EQ(welded.source, (std::vector<std::size_t>{1}));
}

TEST(Weld, splitsAtTouchingEnds) {
    const std::vector<Segment2> lines{{{0, 0}, {9, 0}}, {{6, 4e-7}, {6, 3}}, {{3, -2}, {3, -3e-7}}};
    const WeldedLines welded = weld(lines);
    ASSERT_EQ(welded.pieces.size(), 5U);
    EXPECT_EQ(welded.source, (std::vector<std::size_t>{0, 0, 0, 1, 2}));
    EXPECT_EQ(welded.pieces[0], (Segment2{{0, 0}, {3, -3e-7}}));
    EXPECT_EQ(welded.pieces[1], (Segment2{{3, -3e-7}, {6, 4e-7}}));
    EXPECT_EQ(welded.pieces[2], (Segment2{{6, 4e-7}, {9, 0}}));
}

TEST(Weld, keepsApartWhatIsFartherThanTheWeldDistance) {
    const std::vector<Segment2> lines{
        {{0, 0}, {9, 0}}, {{6, 2e-6}, {6, 3}}, {{9 + 2e-6, 0}, {9, 3}}};
    EXPECT_EQ(weld(lines).pieces, lines);
}

TEST(Weld, movesAPointAndBendsALineByTheWeldDistanceEach) {
    // Each within reach of the next: welding them one after another would drag the last 60 um.
    std::vector<Segment2> lines;
    for (int i = 0; i < 100; ++i) lines.push_back({{i * 6e-7, 0}, {i * 6e-7, 1.0 + i}});
    const WeldedLines welded = weld(lines);
    for (std::size_t i = 0; i < welded.pieces.size(); ++i) {
        const Segment2& line = lines[welded.source[i]];
        EXPECT_LE(distance(welded.pieces[i].a, line), 2.0001 * kWeldDistance);
        EXPECT_LE(distance(welded.pieces[i].b, line), 2.0001 * kWeldDistance);
    }
}

TEST(BoundedFaces, oneRoom) {
    const auto faces = facesOf(test::edgesOf(test::box(0, 0, 8, 6)));
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_EQ(faces[0].outline, test::box(0, 0, 8, 6));
    EXPECT_TRUE(faces[0].holes.empty());
}

TEST(BoundedFaces, nothingFromNothing) {
    EXPECT_TRUE(facesOf({}).empty());
    EXPECT_TRUE(facesOf({{{0, 0}, {1, 0}}}).empty());
    EXPECT_TRUE(facesOf({{{0, 0}, {2, 0}}, {{1, 0}, {3, 0}}, {{0, 0}, {3, 0}}}).empty());
    EXPECT_TRUE(facesOf({{{0, 0}, {0, 0}}}).empty());
    EXPECT_TRUE(facesOf({{{0, 0}, {2, 2}}, {{0, 2}, {2, 0}}}).empty());
}

TEST(BoundedFaces, wallsByLengthAndHeadingClose) {
    for (const int corners : {3, 5, 7, 12, 100, 997}) {
        std::vector<Segment2> lines;
        Point2 from{1, 2};
        for (int i = 0; i < corners; ++i) {
            const Point2 to = from + 0.3 * unitVector(Angle::degrees(360.0 * i / corners));
            lines.push_back({from, to});
            from = to;
        }
        EXPECT_EQ(facesOf(lines).size(), 1U) << corners;
    }
}

TEST(BoundedFaces, roundedTJunctionsDivide) {
    // A partition given by its middle, heading and length, between two sloping walls.
    for (const double degrees : {0.0, 17.0, 30.0, 45.0, 123.4}) {
        const Vec2 along = unitVector(Angle::degrees(degrees)), left = perpendicular(along);
        const auto at = [&](double x, double y) { return Point2{0.1, 0.2} + x * along + y * left; };
        std::vector<Segment2> lines = test::edgesOf({at(0, 0), at(9, 0), at(9, 3), at(0, 3)});
        lines.push_back({at(3, 0), at(3, 3)});
        lines.push_back({at(6, 3), at(6, 0)});
        const auto faces = facesOf(lines);
        ASSERT_EQ(faces.size(), 3U) << degrees;
        for (const Region& face : faces) EXPECT_NEAR(face.area(), 9, 1e-5);
    }
}

TEST(BoundedFaces, danglingAndFreeStandingWallsBoundNothing) {
    auto lines = test::edgesOf(test::box(0, 0, 8, 6));
    lines.push_back({{4, 0}, {4, 2}});    // antenna inside
    lines.push_back({{4, 2}, {5, 3}});    // at its end another
    lines.push_back({{8, 3}, {9, 3}});    // antenna outside
    lines.push_back({{2, 3}, {3, 4}});    // free-standing
    lines.push_back({{20, 0}, {21, 0}});  // elsewhere
    lines.push_back({{6, 4}, {7, 5}});    // a free-standing cross
    lines.push_back({{6, 5}, {7, 4}});
    const auto faces = facesOf(lines);
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_EQ(faces[0].outline, test::box(0, 0, 8, 6)) << "no vertex where antennas stood";
    EXPECT_TRUE(faces[0].holes.empty());
}

TEST(BoundedFaces, antennaToAnIslandLeavesAHole) {
    auto lines = test::edgesOf(test::box(0, 0, 8, 6));
    append(lines, test::box(3, 2, 5, 4));
    lines.push_back({{0, 3}, {3, 3}});  // joins outline and island
    append(lines, test::box(6, 2, 7, 4));
    lines.push_back({{5, 3}, {6, 3}});  // joins two islands
    const auto faces = facesOf(lines);
    ASSERT_EQ(faces.size(), 3U);
    EXPECT_EQ(faces[0].outline, test::box(0, 0, 8, 6));
    ASSERT_EQ(faces[0].holes.size(), 2U);
    EXPECT_EQ(signedArea(faces[0].holes[0]), -4);
    EXPECT_EQ(signedArea(faces[0].holes[1]), -2);
    EXPECT_EQ(faces[0].area(), 42);
}

TEST(BoundedFaces, nestedHoles) {
    std::vector<Segment2> lines;
    for (int i = 0; i < 4; ++i) append(lines, test::box(i, i, 20 - i, 20 - i));
    const auto faces = facesOf(lines);
    ASSERT_EQ(faces.size(), 4U);
    for (int i = 0; i < 4; ++i) {
        const Region& face = faces[static_cast<std::size_t>(i)];
        EXPECT_EQ(face.outline, test::box(i, i, 20 - i, 20 - i));
        EXPECT_EQ(face.holes.size(), i < 3 ? 1U : 0U);
        for (const Polygon& hole : face.holes) EXPECT_LT(signedArea(hole), 0);
    }
}

TEST(BoundedFaces, crossingFences) {
    std::vector<Segment2> lines;
    append(lines, test::box(0, 0, 4, 4));
    append(lines, test::box(2, 2, 6, 6));
    const auto faces = facesOf(lines);
    ASSERT_EQ(faces.size(), 3U);
    EXPECT_EQ(totalArea(faces), 28);
    // Lines that all cross: three through three make four cells.
    lines.clear();
    for (int i = 0; i < 3; ++i) {
        lines.push_back({{i + 0.0, -1}, {i + 0.0, 3}});
        lines.push_back({{-1, i + 0.0}, {3, i + 0.0}});
    }
    EXPECT_EQ(facesOf(lines).size(), 4U);
}

TEST(BoundedFaces, collinearOverlapsAndDoubles) {
    auto lines = test::edgesOf(test::box(0, 0, 8, 6));
    append(lines, test::box(0, 0, 8, 6));
    lines.push_back({{2, 0}, {12, 0}});
    lines.push_back({{6, 0}, {-3, 0}});
    lines.push_back({{8, 1}, {8, 5}});
    lines.push_back({{1, 3e-7}, {7, -3e-7}});
    const auto faces = facesOf(lines);
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_NEAR(faces[0].area(), 48, 1e-5);
}

TEST(BoundedFaces, curvesThatTouchAtAPoint) {
    // A room pinched in its middle is two rooms; a pillar that touches the wall is a hole.
    auto lines = test::edgesOf({{0, 0}, {2, 2}, {4, 0}, {4, 4}, {2, 2}, {0, 4}});
    EXPECT_EQ(facesOf(lines).size(), 2U);
    lines = test::edgesOf(test::box(0, 0, 4, 4));
    append(lines, {{0, 2}, {1, 1}, {2, 2}, {1, 3}});
    const auto faces = facesOf(lines);
    ASSERT_EQ(faces.size(), 2U);
    EXPECT_EQ(totalArea(faces), 16);
    for (const Region& face : faces) EXPECT_EQ(face.locate(interiorPoint(face)), Side::Inside);
}

TEST(BoundedFaces, dependOnTheLinesNotOnTheirOrder) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> coordinate(0, 10);
    std::vector<Segment2> lines;
    for (int i = 0; i < 60; ++i)
        lines.push_back(
            {{coordinate(random), coordinate(random)}, {coordinate(random), coordinate(random)}});
    const auto faces = facesOf(lines);
    ASSERT_GT(faces.size(), 100U);
    for (int round = 0; round < 5; ++round) {
        std::shuffle(lines.begin(), lines.end(), random);
        for (Segment2& line : lines) {
            if (random() % 2 == 0) std::swap(line.a, line.b);
        }
        const auto again = facesOf(lines);
        ASSERT_EQ(again.size(), faces.size());
        for (std::size_t i = 0; i < faces.size(); ++i) {
            EXPECT_EQ(again[i].outline, faces[i].outline);
            EXPECT_EQ(again[i].holes, faces[i].holes);
        }
    }
}

TEST(BoundedFaces, pixelMapsFallIntoTheirPieces) {
    std::mt19937_64 random(9);
    for (int round = 0; round < 20; ++round) {
        const test::PixelMap map(random, 40, 30, 0.35 + 0.02 * round);
        std::vector<Region> free;
        for (Region& face : facesOf(map.boundary())) {
            const Point2 p = interiorPoint(face);
            ASSERT_EQ(face.locate(p), Side::Inside);
            if (map.at(int(std::floor(p.x)), int(std::floor(p.y)))) free.push_back(std::move(face));
        }
        EXPECT_EQ(int(free.size()), map.pieces());
        EXPECT_DOUBLE_EQ(totalArea(free), double(map.freeCount()));
        for (int y = 0; y < map.rows; ++y) {
            for (int x = 0; x < map.columns; ++x) {
                const auto holds = [&](const Region& face) {
                    return face.locate({x + 0.5, y + 0.5}) == Side::Inside;
                };
                EXPECT_EQ(std::count_if(free.begin(), free.end(), holds), map.at(x, y) ? 1 : 0);
            }
        }
    }
}

TEST(BoundedFaces, manyLines) {
    std::vector<Segment2> lines;  // a lattice of separate unit walls
    constexpr int kSide = 100;
    for (int i = 0; i <= kSide; ++i) {
        for (int k = 0; k < kSide; ++k) {
            lines.push_back({{0.1 * k, 0.1 * i}, {0.1 * (k + 1), 0.1 * i}});
            lines.push_back({{0.1 * i, 0.1 * k}, {0.1 * i, 0.1 * (k + 1)}});
        }
    }
    EXPECT_EQ(facesOf(lines).size(), std::size_t{kSide * kSide});
}

TEST(BoundedFaces, thousandsOfEqualLines) {
    std::vector<Segment2> lines(20000, {{0, 0}, {10, 5}});
    append(lines, {{0, 0}, {10, 5}, {0, 5}});
    EXPECT_EQ(facesOf(lines).size(), 1U);
}

TEST(BoundedFaces, refusesCrossingsByTheMillion) {
    std::vector<Segment2> lines;
    for (int i = 0; i < 2000; ++i) {
        lines.push_back({{i + 0.0, -1}, {i + 0.0, 2001}});
        lines.push_back({{-1, i + 0.5}, {2001, i + 0.5}});
    }
    EXPECT_THROW(facesOf(lines), FormatError);
    lines.resize(400);
    EXPECT_EQ(facesOf(lines).size(), 199U * 199U);
}

TEST(Weld, refusesManyLinesUponEachOther) {
    std::vector<Segment2> lines;
    for (int i = 0; i < 20000; ++i) lines.push_back({{i * 1e-3, 0}, {100 - i * 1e-3, 0}});
    EXPECT_THROW(weld(lines), FormatError);
    lines.resize(1000);
    EXPECT_EQ(weld(lines).pieces.size(), 1000U * 1000U);
}

TEST(Weld, oneLineFarAwayIsNoHindrance) {
    std::vector<Segment2> lines;  // a lattice of separate walls
    constexpr int kSide = 120;
    for (int i = 0; i <= kSide; ++i) {
        for (int k = 0; k < kSide; ++k) {
            lines.push_back({{0.4 * k, 0.4 * i}, {0.4 * (k + 1), 0.4 * i}});
            lines.push_back({{0.4 * i, 0.4 * k}, {0.4 * i, 0.4 * (k + 1)}});
        }
    }
    const std::size_t count = lines.size();
    lines.push_back({{9000, 9000}, {9000, 9001}});
    lines.push_back({{-1, 0.2}, {0, 0.2}});  // ends on the middle of one
    EXPECT_EQ(weld(lines).pieces.size(), count + 3);
}

TEST(Weld, serpentinesInAnyHeading) {
    for (const double heading : {0.0, 0.5, 0.7853981}) {
        const Vec2 along{std::cos(heading), std::sin(heading)};
        std::vector<Segment2> lines;
        Point2 from{0, 0};
        for (int i = 0; i < 40001; ++i) {
            const Vec2 step = i % 2 == 1   ? 0.02 * perpendicular(along)
                              : i % 4 == 0 ? 100 * along
                                           : -100 * along;
            lines.push_back({from, from + step});
            from = from + step;
        }
        EXPECT_EQ(weld(lines).pieces.size(), lines.size()) << heading;
    }
}

TEST(BoundedFaces, smallAndFarAway) {
    const auto faces = facesOf(test::edgesOf(test::box(1e6, -1e6, 1e6 + 0.01, -1e6 + 0.01)));
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_NEAR(faces[0].area(), 1e-4, 1e-10);
    // Coordinates beyond any plan are answered all the same.
    for (const double far : {1e150, 1e300})
        EXPECT_EQ(facesOf(test::edgesOf(test::box(-far, -far, far, far))).size(), 1U);
}

}  // namespace planar_map_test
}  // namespace ispace
