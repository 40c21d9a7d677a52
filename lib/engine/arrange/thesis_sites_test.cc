// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "arrange/dense_sites.h"
#include "arrange/placement_rules.h"
#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "support/test_arrange.h"
#include "support/test_paths.h"

namespace ispace {
namespace thesis_sites_test {

Box2 boxOf(Point2 low, Point2 high) { return {low, high}; }

void expectPlace(Point2 place, Point2 wanted, double within = 1e-12) {
    EXPECT_NEAR(place.x, wanted.x, within);
    EXPECT_NEAR(place.y, wanted.y, within);
}

void expectHeadings(const Site& site, const std::vector<double>& degrees) {
    ASSERT_EQ(site.headings.size(), degrees.size());
    for (std::size_t i = 0; i < degrees.size(); ++i)
        EXPECT_NEAR(site.headings[i].degrees(), degrees[i], 1e-9) << i;
}

TEST(GridSearch, DefaultsFollowTheThesis) {
    const GridSearch search = defaultGridSearch(boxOf({0, 0}, {9.6, 8}), 4);
    EXPECT_EQ(search.x, 11);  // 9.6 / 4 * 5 - 1 = 11
    EXPECT_EQ(search.y, 9);
    const GridSearch least = defaultGridSearch(boxOf({0, 0}, {9.6, 8}), 100);
    EXPECT_EQ(least.x, 1);
    EXPECT_EQ(least.y, 1);
}

TEST(GridSearch, PlacesAreInteriorCrossings) {
    const auto places = gridPlaces(boxOf({-1, 2}, {3, 5}), {3, 2});
    ASSERT_EQ(places.size(), 6U);
    EXPECT_EQ(places[0], (Point2{0, 3}));
    EXPECT_EQ(places[2], (Point2{2, 3}));
    EXPECT_EQ(places[5], (Point2{2, 4}));
}

TEST(Headings, AreEvenlyApart) {
    EXPECT_TRUE(headingsAround(0).empty());
    const auto headings = headingsAround(8);
    ASSERT_EQ(headings.size(), 8U);
    for (int i = 0; i < 8; ++i)
        EXPECT_EQ(headings[static_cast<std::size_t>(i)], Angle::degrees(45 * i));
}

TEST(WallCorners, AreWithoutPiecesAndDoubles) {
    const Polygon square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
    EXPECT_EQ(wallCorners(square), square);
    // Begins within a wall; welding moved a piece's end; a vertex is doubled.
    const Polygon pieces = {{1, 0}, {2, 0}, {2, 0}, {2, 0.7}, {2 + 5e-7, 1.1},
                            {2, 2}, {0, 2}, {0, 0}, {0.5, 0}};
    EXPECT_EQ(wallCorners(pieces), (Polygon{{2, 0}, {2, 2}, {0, 2}, {0, 0}}));
    const Polygon slight = {{0, 0}, {1, -1e-5}, {2, 0}, {2, 2}, {0, 2}};
    EXPECT_EQ(wallCorners(slight), slight);
    // A wall that comes back upon itself has an end there.
    const Polygon spike = {{0, 0}, {2, 0}, {2, 2}, {2, 3}, {2, 2}, {0, 2}};
    EXPECT_EQ(wallCorners(spike).size(), 5U);
    EXPECT_LT(wallCorners({{0, 0}, {1, 0}, {1, 0}}).size(), 3U);
    EXPECT_TRUE(wallCorners({}).empty());
}

TEST(WallSites, OfASquareRoom) {
    const Environment room = roomOf("ispace size=4,4\n");
    const auto sites = wallSites(room, kScanHeight, 0.05, 4);
    ASSERT_EQ(sites.size(), 16U);
    const auto at = [&sites](Point2 wanted) {
        const auto found = std::find_if(sites.begin(), sites.end(), [wanted](const Site& site) {
            return distance(site.place, wanted) < 1e-9;
        });
        EXPECT_NE(found, sites.end());
        return found == sites.end() ? Site() : *found;
    };
    // In the middle of a wall the normal alone; towards corners also across and along them.
    expectHeadings(at({-0.4, -1.95}), {90});
    expectHeadings(at({-1.2, -1.95}), {90, 45, 0});
    expectHeadings(at({1.2, -1.95}), {90, 135, 180});
    expectHeadings(at({1.95, 1.2}), {180, -135, -90});
    expectHeadings(at({0.4, 1.95}), {-90});
}

std::size_t headingsOf(const std::vector<Site>& sites) {
    std::size_t count = 0;
    for (const Site& site : sites) count += site.headings.size();
    return count;
}

TEST(WallSites, HaveAsManyHeadingsAsTheThesisHadTimeFor) {
    constexpr double kBeamsPerSecond = 320, kBeams = 181;
    const auto seconds = [](const std::vector<Site>& sites) {
        return static_cast<double>(headingsOf(sites)) * kBeams / kBeamsPerSecond;
    };
    // Table 4.1, 1 min 50 s; table 5.2, 1 min 10 s.
    EXPECT_NEAR(seconds(wallSites(roomOf("ispace size=8,8\n"), kScanHeight, 0.05, 21)), 110, 5);
    const Environment five =
        roomOf("fence path=-2.5,-1.35;1,-1.35;1,1.5;-1.5,1.5;-2.5,0.5 closed=yes\n");
    EXPECT_NEAR(seconds(wallSites(five, kScanHeight, 0.05, 11)), 70, 5);
}

TEST(WallSites, OfOneOrTwoPlacesEachAreAtAnEnd) {
    const Environment room = roomOf("ispace size=4,4\n");
    const auto middle = wallSites(room, kScanHeight, 0.05, 1);
    ASSERT_EQ(middle.size(), 4U);
    for (const Site& site : middle) EXPECT_EQ(site.headings.size(), 5U);
    EXPECT_EQ(headingsOf(wallSites(room, kScanHeight, 0.05, 2)), 8U * 3U);
}

TEST(WallSites, SeeAroundTheCornerOfTheLRoom) {
    const Environment room = environmentOf(readAll(testing::sourcePath("share/scenes/l-room.env")));
    const auto sites = wallSites(room, kScanHeight, 0.1, 2);
    ASSERT_EQ(sites.size(), 12U);
    // The wall from (7, 1) to (1, 1) ends where the room goes on to the north.
    const auto found = std::find_if(sites.begin(), sites.end(), [](const Site& site) {
        return distance(site.place, Point2{3, 0.9}) < 1e-9;
    });
    ASSERT_NE(found, sites.end());
    expectHeadings(*found, {-90, -135, 180});
}

TEST(WallSites, OneWallIsTheSameInPieces) {
    const Environment whole = roomOf("fence path=0,0;4,0;4,3;0,3 closed=yes\n");
    const Environment pieces =
        roomOf("fence path=0,0;1,0;1.7,0;4,0;4,3;2,3;0,3 closed=yes\nwall from=2,3 to=2,4\n");
    const auto sites = wallSites(whole, kScanHeight, 0.05, 5);
    EXPECT_EQ(sites.size(), 20U);
    EXPECT_EQ(sites, wallSites(pieces, kScanHeight, 0.05, 5));
}

TEST(WallSites, PointIntoTheRoomOnHolesToo) {
    const Environment room =
        roomOf("ispace size=8,6\nfence path=1,1;2,1;2.5,2;1,2 closed=yes\ninside at=-1,-1\n");
    ASSERT_EQ(room.indoor().parts.at(0).holes.size(), 1U);
    for (const int times : {1, 3, 21}) {
        const auto sites = wallSites(room, kScanHeight, 0.01, times);
        ASSERT_EQ(sites.size(), static_cast<std::size_t>(8 * times));
        for (const Site& site : sites) {
            EXPECT_EQ(room.indoor().locate(site.place), Side::Inside);
            const Point2 wall = site.place - 0.02 * unitVector(site.headings[0]);
            EXPECT_EQ(room.indoor().locate(wall), Side::Outside);
        }
    }
}

TEST(WallCurves, JoinSheetsWithWhatTheyEndOn) {
    const std::vector<Region> floor = {
        {{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}}};
    const auto corners = [&floor](std::vector<Segment2> sheets) {
        std::vector<std::size_t> counts;
        double area = 0;
        for (const Polygon& curve : wallCurves(floor, sheets)) {
            counts.push_back(wallCorners(curve).size());
            area += signedArea(curve);
        }
        EXPECT_NEAR(area, 15, 1e-9);
        std::sort(counts.begin(), counts.end());
        return counts;
    };
    using Counts = std::vector<std::size_t>;
    EXPECT_EQ(corners({}), (Counts{4, 4}));
    EXPECT_EQ(corners({{{3, 1}, {3, 3}}}), (Counts{2, 4, 4})) << "on its own";
    EXPECT_EQ(corners({{{3, 1}, {3, 3}}, {{3, 3}, {3, 1}}}), (Counts{2, 4, 4})) << "twice";
    EXPECT_EQ(corners({{{3, 0}, {3, 3}}}), (Counts{4, 7})) << "from a wall";
    EXPECT_EQ(corners({{{3, 0}, {3, 2}}, {{3, 2}, {3, 3}}}), (Counts{4, 7})) << "in pieces";
    EXPECT_EQ(corners({{{2, 2}, {4, 4}}}), (Counts{10})) << "from the hole to a corner";
    EXPECT_EQ(corners({{{3, 0}, {3, 4}}}), (Counts{4, 4, 4})) << "from wall to wall";
    EXPECT_EQ(corners({{{3, 3}, {3.5, 3}}, {{3, 3}, {3, 2.5}}, {{3, 3}, {2.5, 3}}}),
              (Counts{4, 4, 5}))
        << "a T";
    // Outside, on the boundary, in the hole.
    EXPECT_EQ(corners({{{5, 0}, {5, 3}}, {{0, 0}, {4, 0}}, {{1.2, 1.5}, {1.8, 1.5}}}),
              (Counts{4, 4}));
    // One that runs out through the wall, which welding does not split.
    EXPECT_EQ(corners({{{3, 1}, {4.5, 1}}}), (Counts{2, 4, 4}));
}

TEST(WallSites, AreOnBothSidesOfWallsWithinTheRoom) {
    const Environment room = roomOf(
        "ispace size=8,6\nwall id=w from=0,-3 to=0,3\ndoor wall=w offset=2 size=1 open=yes\n"
        "inside at=1,0\n");
    const auto sites = wallSites(room, 0.15, 0.1, 2);
    // The walls above and below in two halves each; both sides of both pieces of the wall.
    ASSERT_EQ(sites.size(), (2U + 4U + 4U) * 2U);
    const auto found = std::find_if(sites.begin(), sites.end(), [](const Site& site) {
        return distance(site.place, Point2{-0.1, 2.0 / 3}) < 1e-9;
    });
    ASSERT_NE(found, sites.end());
    // Its own side, and around its end at the door, towards the door first.
    expectHeadings(*found, {180, -90, 0});
    for (const Site& site : sites) EXPECT_EQ(room.indoor().locate(site.place), Side::Inside);
    EXPECT_EQ(wallSites(room, 100, 0.1, 2).size(), 8U) << "above all walls";
}

TEST(WallSites, LookAroundTheEndsOfWallsAtAnyAngle) {
    for (int degrees = 0; degrees < 360; degrees += 7) {
        const Vec2 half = 1.3 * unitVector(Angle::degrees(degrees));
        std::string wall = "wall from=" + formatDouble(-half.x) + ',' + formatDouble(-half.y);
        wall.append(" to=").append(formatDouble(half.x)).append(",");
        wall.append(formatDouble(half.y)).append("\n");
        const auto sites =
            wallSites(roomOf("ispace size=8,6\ninside at=3,2\n" + wall), kScanHeight, 0.1, 2);
        ASSERT_EQ(sites.size(), (4U + 2U) * 2U);
        int ends = 0;
        for (const Site& site : sites) {
            const Vec2 place = site.place - Point2{};
            if (length(place) > 1) continue;
            ASSERT_EQ(site.headings.size(), 3U) << degrees;
            const double along = dot(unitVector(site.headings[1]), half) / length(half);
            EXPECT_NEAR(along, dot(place, half) > 0 ? 1 : -1, 1e-9) << degrees;
            ++ends;
        }
        EXPECT_EQ(ends, 4) << degrees;
    }
}

TEST(WallSites, StandBeforeTheFacesOfThickWalls) {
    const Environment room = roomOf(
        "fence path=-4,-3;4,-3;4,3;-4,3 closed=yes thickness=0.2\n"
        "wall from=-4,0 to=0,0 thickness=0.1\n");
    const Slice slice = room.slice(0.15);
    const auto sites = wallSites(room, 0.15, 0.05, 4);
    ASSERT_EQ(sites.size(), 8U * 4U);
    for (const Site& site : sites) {
        EXPECT_FALSE(slice.blocked(site.place));
        EXPECT_TRUE(slice.blocked(site.place - 0.06 * unitVector(site.headings[0])));
    }
}

TEST(WallSites, AreNoneWithoutTimes) {
    EXPECT_TRUE(wallSites(roomOf("ispace size=4,4\n"), kScanHeight, 0.05, 0).empty());
}

TEST(WallSites, RefuseTooMany) {
    const Environment room = roomOf("ispace size=4,4\n");
    try {
        wallSites(room, kScanHeight, 0.05, 250001);
        FAIL() << "a million and four";
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(),
                     "250001 places along each of 4 walls make 1000004: more than a million are "
                     "too many, use fewer (--times)");
    }
    EXPECT_THROW(wallSites(room, kScanHeight, 0.05, 2'000'000'000), UsageError);
}

TEST(WallSites, OfRaggedWallsEachHaveTheirs) {
    std::string path;
    constexpr int kCorners = 5000;
    for (int i = 0; i < kCorners; ++i) {
        const double radius = i % 2 == 0 ? 50 : 50.04;
        const Vec2 corner = radius * unitVector(Angle::degrees(360.0 * i / kCorners));
        path.append(i == 0 ? "" : ";").append(formatDouble(corner.x));
        path.append(",").append(formatDouble(corner.y));
    }
    const Environment room = roomOf("fence closed=yes path=" + path + '\n');
    EXPECT_EQ(wallSites(room, kScanHeight, 0.05, 2).size(), 2U * kCorners);
}

TEST(RandomPlace, FillsTheLimitsEvenly) {
    const Box2 limits = boxOf({-3, 10}, {5, 12});
    constexpr std::uint64_t kPlaces = 4000;
    std::array<int, 4> quarters{};
    for (std::uint64_t k = 0; k < kPlaces; ++k) {
        const Point2 place = randomPlace(limits, {7, "laser1"}, k);
        ASSERT_TRUE(place.x >= -3 && place.x < 5 && place.y >= 10 && place.y < 12);
        ++quarters[(place.x < 1 ? 0U : 1U) + (place.y < 11 ? 0U : 2U)];
    }
    for (const int count : quarters) EXPECT_NEAR(count, 1000, 110);  // four deviations
}

TEST(RandomPlace, FillsTheDiscEvenly) {
    constexpr int kPlaces = 4000;
    int inner = 0, left = 0;
    for (std::uint64_t k = 0; k < kPlaces; ++k) {
        const Point2 place = randomPlaceAbout({2, -1}, 3, {7, "laser1"}, k);
        const double radius = distance(place, Point2{2, -1});
        ASSERT_LE(radius, 3 + 1e-12);
        inner += radius < 3 / std::sqrt(2) ? 1 : 0;
        left += place.x < 2 ? 1 : 0;
    }
    EXPECT_NEAR(inner, kPlaces / 2, 130);
    EXPECT_NEAR(left, kPlaces / 2, 130);
    EXPECT_EQ(randomPlaceAbout({2, -1}, 0, {7, "laser1"}, 5), (Point2{2, -1}));
}

TEST(RandomPlace, DependsOnWhatItIsFor) {
    const Box2 limits = boxOf({0, 0}, {1, 1});
    const Point2 place = randomPlace(limits, {1, "a"}, 0);
    EXPECT_EQ(place, randomPlace(limits, {1, "a"}, 0));
    EXPECT_NE(place, randomPlace(limits, {2, "a"}, 0));
    EXPECT_NE(place, randomPlace(limits, {1, "b"}, 0));
    EXPECT_NE(place, randomPlace(limits, {1, "a"}, 1));
    EXPECT_NE(place, randomPlace(limits, {1, "a"}, std::uint64_t{1} << 30U));
    EXPECT_NE(place, randomPlace(limits, {1, "a", 1}, 0));
    EXPECT_NE(randomPlaceAbout({}, 1, {1, "a"}, 0), randomPlaceAbout({}, 1, {1, "a", 1}, 0));
    // Moved limits move it.
    expectPlace(randomPlace(boxOf({5, -7}, {6, -6}), {1, "a"}, 0), {place.x + 5, place.y - 7});
}

}  // namespace thesis_sites_test
}  // namespace ispace
