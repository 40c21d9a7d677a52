// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/placement_rules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "base/error.h"
#include "geom/predicates.h"
#include "support/test_arrange.h"
#include "support/test_floor_plans.h"

namespace ispace {
namespace sites_test {

Polygon squareAbout(Point2 p, double half) {
    return {p + Vec2{-half, -half}, p + Vec2{half, -half}, p + Vec2{half, half},
            p + Vec2{-half, half}};
}

TEST(SiteValidity, KeepsIndoorsAndClearOfObjects) {
    const Environment room = roomOf("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    const SiteValidity validity(room, {});
    EXPECT_TRUE(validity.isValid({0, 0}));
    EXPECT_FALSE(validity.isValid({1, 1}));
    EXPECT_FALSE(validity.isValid({1.5, 1})) << "solids are closed";
    EXPECT_FALSE(validity.isValid({4, 0})) << "on the wall";
    EXPECT_FALSE(validity.isValid({5, 0}));
    EXPECT_FALSE(validity.isValid({1e300, 0}));
    EXPECT_TRUE(validity.isValid({std::nextafter(4.0, 0), 0}));
    EXPECT_TRUE(validity.isValid({std::nextafter(1.5, 2), 1}));
    SiteRules high;
    high.height = 1.2;
    EXPECT_TRUE(SiteValidity(room, high).isValid({1, 1}));
}

TEST(SiteValidity, HasNobodyOnWallsWithinTheRoom) {
    const Environment room = roomOf("ispace size=8,6,2.5\nwall from=-1,1 to=2,1 height=1\n");
    const SiteValidity validity(room, {});
    EXPECT_FALSE(validity.isValid({0.5, 1}));
    EXPECT_FALSE(validity.isValid({2, 1}));
    EXPECT_TRUE(validity.isValid({0.5, std::nextafter(1.0, 2)}));
    EXPECT_TRUE(validity.isValid({2.5, 1}));
    SiteRules high;
    high.height = 1.5;
    EXPECT_TRUE(SiteValidity(room, high).isValid({0.5, 1}));
}

TEST(SiteValidity, KeepsClearance) {
    const Environment room = roomOf("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    SiteRules rules;
    rules.clearance = 0.3;
    const SiteValidity validity(room, rules);
    EXPECT_TRUE(validity.isValid({3.7, 0})) << "just as far as is asked for";
    EXPECT_FALSE(validity.isValid({3.71, 0}));
    EXPECT_TRUE(validity.isValid({1.8, 1}));
    EXPECT_FALSE(validity.isValid({1.79, 1}));
    const double across = 0.3 / std::sqrt(2);
    EXPECT_TRUE(validity.isValid({1.5 + across + 1e-5, 1.5 + across}));
    EXPECT_FALSE(validity.isValid({1.5 + across - 1e-5, 1.5 + across}));
    rules.clearance = 100;
    EXPECT_FALSE(SiteValidity(room, rules).isValid({0, 0}));
}

TEST(SiteValidity, KeepsOutAndIn) {
    const Environment room = roomOf("ispace size=8,6,2.5\n");
    SiteRules rules;
    rules.keep_out = {squareAbout({1, 1}, 0.5), squareAbout({-1, -1}, 0.5)};
    const SiteValidity out(room, rules);
    EXPECT_TRUE(out.isValid({0, 0}));
    EXPECT_FALSE(out.isValid({1, 1}));
    EXPECT_FALSE(out.isValid({-1.5, -1})) << "closed";
    rules.keep_in = {squareAbout({1, 1}, 1), squareAbout({3.5, 0}, 1)};
    const SiteValidity both(room, rules);
    EXPECT_FALSE(both.isValid({-3, 0}));
    EXPECT_TRUE(both.isValid({0, 0})) << "closed";
    EXPECT_FALSE(both.isValid({1, 1}));
    EXPECT_TRUE(both.isValid({3.5, 0}));
    EXPECT_FALSE(both.isValid({4.2, 0})) << "kept in, yet not indoors";
}

TEST(SiteValidity, KeepsNearWalls) {
    const Environment room = roomOf("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    SiteRules rules;
    rules.wall_within = 0.1;
    const SiteValidity validity(room, rules);
    EXPECT_TRUE(validity.isValid({3.95, 0}));
    EXPECT_TRUE(validity.isValid({3.9, 0}));
    EXPECT_FALSE(validity.isValid({3.89, 0}));
    EXPECT_FALSE(validity.isValid({1.55, 1})) << "objects are no walls";
    rules.clearance = 0.2;
    EXPECT_FALSE(SiteValidity(room, rules).isValid({3.9, 0}));
    const Environment divided = roomOf("ispace size=8,6,2.5\nwall from=0,-3 to=0,1\n");
    rules.clearance = 0;
    EXPECT_TRUE(SiteValidity(divided, rules).isValid({0.1, 0}));
    EXPECT_FALSE(SiteValidity(divided, rules).isValid({0.1, 2}));
}

/// Returns points that are hard to decide: at random, at corners, on and about lines, in line with
/// corners.
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

TEST(SiteValidity, DecidesAsThePlainTest) {
    std::uint64_t seed = 0;
    for (const auto& [walls, heading] : {std::pair(10, 0), {60, 0}, {60, 31}, {300, 45}}) {
        const Environment plan = roomOf(testing::buildingPlan(
            walls, {.open_doors = walls == 60, .heading = Angle::degrees(heading)}));
        const SiteValidity validity(plan, {});
        const Slice slice = plan.slice(kScanHeight);
        int valid = 0;
        for (const Point2 p : hardPlaces(plan, ++seed)) {
            const bool is_valid = isPlainlyValid(plan, slice, p);
            ASSERT_EQ(validity.isValid(p), is_valid) << p.x << ' ' << p.y;
            valid += is_valid ? 1 : 0;
        }
        EXPECT_GT(valid, 20);
    }
}

TEST(SiteValidity, DecidesAsThePlainTestWhereLinesRunThroughCellCentres) {
    // Walls every five centimetres: whichever centres there are, some lie on them.
    std::string lines = "ispace size=4,4\ninside at=0,0.01\n";
    for (int i = -39; i < 40; ++i) {
        const std::string x = std::to_string(i * 5) + "cm";
        lines += "fence path=" + x + ",0.5;" + x + ",1.9\n";
    }
    const Environment room = roomOf(lines);
    const SiteValidity validity(room, {});
    const Slice slice = room.slice(kScanHeight);
    for (const Point2 p : hardPlaces(room, 5))
        ASSERT_EQ(validity.isValid(p), isPlainlyValid(room, slice, p)) << p.x << ' ' << p.y;
}

TEST(ValidSites, KeepOrderAndComeOnce) {
    const Environment room = roomOf("ispace size=8,6,2.5\ncube at=1,1 size=1,1,1\n");
    const auto headings = [](std::initializer_list<double> degrees) {
        std::vector<Angle> angles;
        for (const double angle : degrees) angles.push_back(Angle::degrees(angle));
        return angles;
    };
    SilentProgress progress;
    bool is_complete = true;
    const SiteValidity validity(room, {});
    const auto sites = validSites(validity,
                                  {{{2, 0}, headings({0, 90})},
                                   {{1, 1}, headings({0})},
                                   {{-2, 0}, headings({5})},
                                   {{2, 0}, headings({90, 180})},
                                   {{9, 9}, headings({0})},
                                   {{-2, -0.0}, headings({5})}},
                                  progress, is_complete);
    ASSERT_EQ(sites.size(), 2U);
    EXPECT_EQ(sites[0], (Site{{2, 0}, headings({0, 90, 180})}));
    EXPECT_EQ(sites[1], (Site{{-2, 0}, headings({5})}));
    EXPECT_TRUE(validSites(validity, {}, progress, is_complete).empty());
    EXPECT_TRUE(validSites(validity, {{{9, 9}, headings({0})}}, progress, is_complete).empty());
}

/// Says stop from the first.
class Stopped final : public Progress {
  public:
    void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
    void advance(std::int64_t count) override { done += count; }
    void end() override {}
    [[nodiscard]] bool stopped() const override { return true; }
    std::atomic<std::int64_t> done = 0;
};

TEST(ValidSites, AreASampleAfterAStop) {
    const Environment room = roomOf("ispace size=80,60,2.5\n");
    std::vector<Site> all;
    for (int i = 0; i < 200; ++i)
        for (int k = 0; k < 200; ++k)
            all.push_back({{-39 + 78 * i / 200.0, -29 + 58 * k / 200.0}, {Angle()}});
    Stopped stopped;
    bool is_complete = true;
    const auto sites = validSites(SiteValidity(room, {}), all, stopped, is_complete);
    EXPECT_FALSE(is_complete);
    EXPECT_EQ(stopped.done, 512);
    EXPECT_EQ(sites.size(), 512U);
    Box2 box;
    for (const Site& site : sites) box.add(site.place);
    EXPECT_GT(box.width(), 70);
    EXPECT_GT(box.depth(), 50);
}

std::vector<Site> sitesOf(const std::string& text) {
    return readSites(text, "sites.csv", {Angle::degrees(0), Angle::degrees(180)});
}

std::string findingsOf(const std::string& text) {
    try {
        static_cast<void>(sitesOf(text));
    } catch (const FormatError& error) {
        std::string out;
        for (const Diagnostic& diagnostic : error.diagnostics()) out += diagnostic.text() + '\n';
        return out;
    }
    return "";
}

TEST(ReadSites, TakesPlacesAndHeadings) {
    const auto sites =
        sitesOf("# of last year\n\n x, y ,heading\r\n1,2\r\n -3.5 , 4e-1 , 90 # here\n1,-2,\n");
    ASSERT_EQ(sites.size(), 3U);
    EXPECT_EQ(sites[0], (Site{{1, 2}, {Angle::degrees(0), Angle::degrees(180)}}));
    EXPECT_EQ(sites[1], (Site{{-3.5, 0.4}, {Angle::degrees(90)}}));
    EXPECT_EQ(sites[2].headings.size(), 2U);
    EXPECT_TRUE(sitesOf("").empty());
    EXPECT_TRUE(sitesOf("x,y\n#1,2").empty());
}

TEST(ReadSites, JoinsLinesOfOnePlace) {
    const auto sites = sitesOf("0,1,90\n5,5,0\n-0,1,450\n0,1,-180\n0,1\n");
    ASSERT_EQ(sites.size(), 2U);
    EXPECT_EQ(sites[0].headings,
              (std::vector<Angle>{Angle::degrees(90), Angle::degrees(-180), Angle::degrees(0)}));
    EXPECT_EQ(sites[1].place, (Point2{5, 5}));
}

std::vector<std::vector<Site>> sitesOfTwoRooms(const std::string& text) {
    const PlaceRooms rooms{{"ground", "upper"}, [](const std::string& name) {
                               if (name == "*") return std::vector<std::size_t>{0, 1};
                               if (name != "ground" && name != "upper")
                                   throw UsageError("no storey " + name);
                               return std::vector<std::size_t>{name == "upper" ? 1U : 0U};
                           }};
    return readSites(text, "sites.csv", {Angle()}, rooms);
}

TEST(ReadSites, OfSeveralRoomsNamesThem) {
    const auto sites = sitesOfTwoRooms(
        "storey/x,y,heading\nupper/1,2\n*/ 3,4,90 # both\n ground/1,2\nupper/3,4,0\n");
    ASSERT_EQ(sites.size(), 2U);
    EXPECT_EQ(sites[0], (std::vector<Site>{{{3, 4}, {Angle::degrees(90)}}, {{1, 2}, {Angle()}}}));
    EXPECT_EQ(sites[1],
              (std::vector<Site>{{{1, 2}, {Angle()}}, {{3, 4}, {Angle::degrees(90), Angle()}}}));
    const auto wrong = [](const std::string& text) {
        try {
            static_cast<void>(sitesOfTwoRooms(text));
        } catch (const FormatError& error) {
            return error.diagnostics().front().text();
        }
        return std::string();
    };
    EXPECT_EQ(wrong("ground/0,0\n 1,2,3\n"),
              "sites.csv:2:2: error: `1,2,3` names no storey, as in ground/1,2,3");
    EXPECT_EQ(wrong("attic/1,2\n"), "sites.csv:1:1: error: no storey attic");
    EXPECT_EQ(wrong("upper/1,a\n"), "sites.csv:1:9: error: y `a` is no number");
    EXPECT_EQ(wrong("upper/1\n"),
              "sites.csv:1:1: error: 1 field, a line is STOREY/x,y or STOREY/x,y,heading");
}

TEST(ReadSites, SaysWhereAndWhatIsWrong) {
    EXPECT_EQ(findingsOf("1,2\n 1,a,3\n"), "sites.csv:2:4: error: y `a` is no number\n");
    EXPECT_EQ(findingsOf("7\n"), "sites.csv:1:1: error: 1 field, a line is x,y or x,y,heading\n");
    EXPECT_EQ(findingsOf("1,2,3, 4\n"),
              "sites.csv:1:8: error: 4 fields, a line is x,y or x,y,heading\n");
    EXPECT_EQ(findingsOf("1,\n"), "sites.csv:1:3: error: y is missing\n");
    // A byte order mark takes up no column.
    EXPECT_EQ(findingsOf("\xef\xbb\xbf"
                         "1,a\n"),
              "sites.csv:1:3: error: y `a` is no number\n");
    EXPECT_EQ(findingsOf("nan,1\n"), "sites.csv:1:1: error: x `nan` is no number\n");
    EXPECT_EQ(findingsOf("1,1e7\n"),
              "sites.csv:1:3: error: y `1e7` is too large: a million at most\n");
    // A header stands before all sites.
    EXPECT_EQ(findingsOf("1,2\nx,y\n"), "sites.csv:2:1: error: x `x` is no number\n");
    // All that is wrong is told.
    EXPECT_EQ(findingsOf("1\n2,3\n4\n"),
              "sites.csv:1:1: error: 1 field, a line is x,y or x,y,heading\n"
              "sites.csv:3:1: error: 1 field, a line is x,y or x,y,heading\n");
    std::string much;
    for (int i = 0; i < 100; ++i) much += "a,b\n";
    EXPECT_THROW(sitesOf(much), FormatError);
}

}  // namespace sites_test
}  // namespace ispace
