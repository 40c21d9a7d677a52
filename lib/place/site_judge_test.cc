// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "env/test_plans.h"
#include "geom/predicates.h"
#include "place/inside_index.h"
#include "place/sites.h"
#include "place/test_room.h"

namespace ispace {
namespace {

Polygon squareAbout(Point2 p, double half) {
    return {p + Vec2{-half, -half}, p + Vec2{half, -half}, p + Vec2{half, half},
            p + Vec2{-half, half}};
}

TEST(SiteJudge, KeepsIndoorsAndClearOfObjects) {
    const Environment room = roomOf("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    const SiteJudge judge(room, {});
    EXPECT_TRUE(judge.isValid({0, 0}));
    EXPECT_FALSE(judge.isValid({1, 1}));
    EXPECT_FALSE(judge.isValid({1.5, 1})) << "solids are closed";
    EXPECT_FALSE(judge.isValid({4, 0})) << "on the wall";
    EXPECT_FALSE(judge.isValid({5, 0}));
    EXPECT_FALSE(judge.isValid({1e300, 0}));
    EXPECT_TRUE(judge.isValid({std::nextafter(4.0, 0), 0}));
    EXPECT_TRUE(judge.isValid({std::nextafter(1.5, 2), 1}));
    SiteRules high;
    high.height = 1.2;
    EXPECT_TRUE(SiteJudge(room, high).isValid({1, 1}));
}

TEST(SiteJudge, HasNobodyOnWallsWithinTheRoom) {
    const Environment room = roomOf("ispace size=8,6,2.5\nwall from=-1,1 to=2,1 height=1\n");
    const SiteJudge judge(room, {});
    EXPECT_FALSE(judge.isValid({0.5, 1}));
    EXPECT_FALSE(judge.isValid({2, 1}));
    EXPECT_TRUE(judge.isValid({0.5, std::nextafter(1.0, 2)}));
    EXPECT_TRUE(judge.isValid({2.5, 1}));
    SiteRules high;
    high.height = 1.5;
    EXPECT_TRUE(SiteJudge(room, high).isValid({0.5, 1}));
}

TEST(SiteJudge, KeepsClearance) {
    const Environment room = roomOf("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    SiteRules rules;
    rules.clearance = 0.3;
    const SiteJudge judge(room, rules);
    EXPECT_TRUE(judge.isValid({3.7, 0})) << "just as far as is asked for";
    EXPECT_FALSE(judge.isValid({3.71, 0}));
    EXPECT_TRUE(judge.isValid({1.8, 1}));
    EXPECT_FALSE(judge.isValid({1.79, 1}));
    const double across = 0.3 / std::sqrt(2);
    EXPECT_TRUE(judge.isValid({1.5 + across + 1e-5, 1.5 + across}));
    EXPECT_FALSE(judge.isValid({1.5 + across - 1e-5, 1.5 + across}));
    rules.clearance = 100;
    EXPECT_FALSE(SiteJudge(room, rules).isValid({0, 0}));
}

TEST(SiteJudge, KeepsOutAndIn) {
    const Environment room = roomOf("ispace size=8,6,2.5\n");
    SiteRules rules;
    rules.keep_out = {squareAbout({1, 1}, 0.5), squareAbout({-1, -1}, 0.5)};
    const SiteJudge out(room, rules);
    EXPECT_TRUE(out.isValid({0, 0}));
    EXPECT_FALSE(out.isValid({1, 1}));
    EXPECT_FALSE(out.isValid({-1.5, -1})) << "closed";
    rules.keep_in = {squareAbout({1, 1}, 1), squareAbout({3.5, 0}, 1)};
    const SiteJudge both(room, rules);
    EXPECT_FALSE(both.isValid({-3, 0}));
    EXPECT_TRUE(both.isValid({0, 0})) << "closed";
    EXPECT_FALSE(both.isValid({1, 1}));
    EXPECT_TRUE(both.isValid({3.5, 0}));
    EXPECT_FALSE(both.isValid({4.2, 0})) << "kept in, yet not indoors";
}

TEST(SiteJudge, KeepsNearWalls) {
    const Environment room = roomOf("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    SiteRules rules;
    rules.wall_within = 0.1;
    const SiteJudge judge(room, rules);
    EXPECT_TRUE(judge.isValid({3.95, 0}));
    EXPECT_TRUE(judge.isValid({3.9, 0}));
    EXPECT_FALSE(judge.isValid({3.89, 0}));
    EXPECT_FALSE(judge.isValid({1.55, 1})) << "objects are no walls";
    rules.clearance = 0.2;
    EXPECT_FALSE(SiteJudge(room, rules).isValid({3.9, 0}));
    const Environment divided = roomOf("ispace size=8,6,2.5\nwall from=0,-3 to=0,1\n");
    rules.clearance = 0;
    EXPECT_TRUE(SiteJudge(divided, rules).isValid({0.1, 0}));
    EXPECT_FALSE(SiteJudge(divided, rules).isValid({0.1, 2}));
}

/// Places where it is decided: at random, at corners, on and about lines, in line with corners.
std::vector<Point2> hardPlaces(const Environment& plan, std::uint64_t seed) {
    std::vector<Segment2> lines;
    plan.indoor().forEachEdge([&lines](const Segment2& edge) { lines.push_back(edge); });
    plan.slice(kScanHeight).forEachLine([&lines](const Segment2& line) { lines.push_back(line); });
    const Box2& limits = plan.limits();
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    std::uniform_int_distribution<std::size_t> one(0, lines.size() - 1);
    std::vector<Point2> places;
    for (int i = 0; i < 300; ++i) {
        const Point2 anywhere{limits.low.x + share(random) * limits.width(),
                              limits.low.y + share(random) * limits.depth()};
        const auto [a, b] = lines[one(random)];
        const Point2 on = a + share(random) * (b - a);
        constexpr double kFar = std::numeric_limits<double>::infinity();
        places.insert(places.end(), {anywhere,
                                     a,
                                     on,
                                     a + 0.5 * (b - a),
                                     {std::nextafter(a.x, kFar), a.y},
                                     {on.x, std::nextafter(on.y, -kFar)},
                                     {anywhere.x, a.y},
                                     {a.x, anywhere.y}});
    }
    return places;
}

bool isPlainlyValid(const Environment& plan, const Slice& slice, Point2 p) {
    return plan.indoor().locate(p) == Side::Inside && !slice.blocked(p) &&
           std::none_of(slice.sheets.begin(), slice.sheets.end(), [p](const Segment2& sheet) {
               return intersects(sheet, {p, p});
           });
}

TEST(SiteJudge, DecidesAsThePlainTest) {
    std::uint64_t seed = 0;
    for (const auto& [walls, heading] : {std::pair(10, 0), {60, 0}, {60, 31}, {300, 45}}) {
        const Environment plan = roomOf(testing::buildingPlan(
            walls, {.open_doors = walls == 60, .heading = Angle::degrees(heading)}));
        const SiteJudge judge(plan, {});
        const Slice slice = plan.slice(kScanHeight);
        int valid = 0;
        for (const Point2 p : hardPlaces(plan, ++seed)) {
            const bool is_valid = isPlainlyValid(plan, slice, p);
            ASSERT_EQ(judge.isValid(p), is_valid) << p.x << ' ' << p.y;
            valid += is_valid ? 1 : 0;
        }
        EXPECT_GT(valid, 20);
    }
}

TEST(SiteJudge, DecidesAsThePlainTestWhereLinesRunThroughCellCentres) {
    // Walls every five centimetres: whichever centres there are, some lie on them.
    std::string lines = "ispace size=4,4\ninside at=0,0.01\n";
    for (int i = -39; i < 40; ++i) {
        const std::string x = std::to_string(i * 5) + "cm";
        lines += "fence path=" + x + ",0.5;" + x + ",1.9\n";
    }
    const Environment room = roomOf(lines);
    const SiteJudge judge(room, {});
    const Slice slice = room.slice(kScanHeight);
    for (const Point2 p : hardPlaces(room, 5))
        ASSERT_EQ(judge.isValid(p), isPlainlyValid(room, slice, p)) << p.x << ' ' << p.y;
}

TEST(InsideIndex, DecidesAsLocateOnKnownPoints) {
    // Small whole numbers: places, corners and lines often meet.
    std::mt19937_64 random(3);
    std::uniform_int_distribution<int> whole(0, 6);
    for (int round = 0; round < 200; ++round) {
        Region region;
        const int corners = 3 + round % 5;
        for (int i = 0; i < corners; ++i)
            region.outline.push_back({double(whole(random)), double(whole(random))});
        const InsideIndex index({region});
        for (int x = -1; x <= 14; ++x)
            for (int y = -1; y <= 14; ++y) {
                const Point2 p{x / 2.0, y / 2.0};
                ASSERT_EQ(index.isInside(p), region.locate(p) == Side::Inside);
            }
    }
    EXPECT_FALSE(InsideIndex({}).isInside({0, 0}));
    // Of no width.
    EXPECT_FALSE(InsideIndex({{{{0, 0}, {5, 0}, {2, 0}}, {}}}).isInside({1, 0}));
}

TEST(InsideIndex, DoesWithoutAKnownPointOnTheBoundary) {
    Region region{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}};
    const Grid cells = InsideIndex({region}).cells();
    const Point2 center = cells.center(cells.cell(cells.columns / 2, cells.rows / 2));
    region.holes = {{center, center + Vec2{-0.5, 0.5}, center + Vec2{0.5, 0.5}}};
    const InsideIndex index({region});
    ASSERT_EQ(index.cells(), cells) << "few more edges do not change them";
    for (int x = -10; x <= 10; ++x)
        for (int y = -10; y <= 10; ++y) {
            const Point2 p = center + Vec2{0.004 * x, 0.004 * y};
            EXPECT_EQ(index.isInside(p), region.locate(p) == Side::Inside);
        }
}

TEST(ValidSites, KeepOrderAndComeOnce) {
    const Environment room = roomOf("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    const auto headings = [](std::initializer_list<double> degrees) {
        std::vector<Angle> angles;
        for (const double angle : degrees) angles.push_back(Angle::degrees(angle));
        return angles;
    };
    SilentProgress progress;
    const SiteJudge judge(room, {});
    const auto sites = validSites(judge,
                                  {{{2, 0}, headings({0, 90})},
                                   {{1, 1}, headings({0})},
                                   {{-2, 0}, headings({5})},
                                   {{2, 0}, headings({90, 180})},
                                   {{9, 9}, headings({0})},
                                   {{-2, -0.0}, headings({5})}},
                                  progress);
    ASSERT_EQ(sites.size(), 2U);
    EXPECT_EQ(sites[0], (Site{{2, 0}, headings({0, 90, 180})}));
    EXPECT_EQ(sites[1], (Site{{-2, 0}, headings({5})}));
    EXPECT_TRUE(validSites(judge, {}, progress).empty());
    EXPECT_TRUE(validSites(judge, {{{9, 9}, headings({0})}}, progress).empty());
}

}  // namespace
}  // namespace ispace
