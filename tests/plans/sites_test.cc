// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of candidates in any plan.
#include "arrange/placement_rules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "env/level.h"
#include "geom/predicates.h"
#include "plan_scene.h"
#include "random_plan.h"
#include "record/edit.h"

namespace ispace::testing {
namespace {

constexpr std::uint64_t kPlans = 12;

PlanOptions optionsOf(std::uint64_t seed) {
    PlanOptions options;
    options.seed = seed;
    options.area = 20 + 12 * static_cast<double>(seed);
    options.is_askew = seed % 2 == 0;
    return options;
}

/// All sites of a plan.
std::vector<Site> allSites(const Environment& plan) {
    const std::vector<Region> floor = plan.level(kScanHeight)->freeFloor();
    std::vector<Site> sites = wallSites(plan, kScanHeight, 0.05, 7);
    const auto add = [&sites](const std::vector<Point2>& places) {
        for (const Point2 place : places) sites.push_back({place, {Angle()}});
    };
    add(gridPlaces(plan.limits(), {11, 11}));
    add(latticePlaces(plan.limits(), 0.4));
    const std::vector<Segment2> sheets = plan.slice(kScanHeight).sheets;
    add(placesAlong(floor, 0.3, 0.02, sheets));
    add(medialPlaces(floor, 0.4, sheets));
    for (std::uint64_t k = 0; k < 100; ++k)
        sites.push_back({randomPlace(plan.limits(), {1, "laser"}, k), {Angle()}});
    return sites;
}

TEST(Sites, ThatAreValidStandIndoorsAndClear) {
    SilentProgress progress;
    for (std::uint64_t seed = 1; seed <= kPlans; ++seed) {
        const Environment plan = environmentOf(randomPlan(optionsOf(seed)));
        const Slice slice = plan.slice(kScanHeight);
        const SiteValidity validity(plan, {});
        const std::vector<Site> sites = allSites(plan);
        std::size_t valid = 0;
        for (const Site& site : sites) {
            const Point2 p = site.place;
            const bool is_valid =
                plan.indoor().locate(p) == Side::Inside && !slice.blocked(p) &&
                std::none_of(slice.sheets.begin(), slice.sheets.end(), [p](const Segment2& sheet) {
                    return intersects(sheet, {p, p});
                });
            ASSERT_EQ(validity.isValid(p), is_valid) << seed << ": " << p.x << ' ' << p.y;
            valid += is_valid ? 1 : 0;
        }
        bool is_complete = true;
        const std::vector<Site> kept = validSites(validity, sites, progress, is_complete);
        EXPECT_TRUE(is_complete);
        EXPECT_LE(kept.size(), valid);
        EXPECT_GE(kept.size(), sites.size() / 3);
    }
}

TEST(Sites, AlongWallsAreFreeButNearCorners) {
    for (std::uint64_t seed = 1; seed <= kPlans; ++seed) {
        const Environment plan = environmentOf(randomPlan(optionsOf(seed)));
        const SiteValidity validity(plan, {});
        const std::vector<Region> floor = plan.level(kScanHeight)->freeFloor();
        const std::vector<Segment2> sheets = plan.slice(kScanHeight).sheets;
        const std::vector<Point2> places = placesAlong(floor, 0.25, 0.02, sheets);
        const auto valid = std::count_if(places.begin(), places.end(),
                                         [&](Point2 place) { return validity.isValid(place); });
        EXPECT_GE(static_cast<double>(valid), 0.97 * static_cast<double>(places.size())) << seed;
        for (const Point2 place : medialPlaces(floor, 0.3, sheets))
            ASSERT_TRUE(validity.isValid(place)) << seed;
    }
}

TEST(Sites, KeepTheirClearance) {
    const Environment plan = environmentOf(randomPlan(optionsOf(5)));
    SiteRules rules;
    rules.clearance = 0.2503;
    rules.wall_within = 0.6007;
    const SiteValidity validity(plan, rules), free_of_rules(plan, {});
    std::vector<Segment2> walls, lines;
    plan.indoor().forEachEdge([&](const Segment2& edge) { walls.push_back(edge); });
    const Slice slice = plan.slice(kScanHeight);
    walls.insert(walls.end(), slice.sheets.begin(), slice.sheets.end());
    lines = walls;
    slice.forEachLine([&](const Segment2& line) { lines.push_back(line); });
    const auto nearest = [](const std::vector<Segment2>& among, Point2 p) {
        double least = 1e300;
        for (const Segment2& line : among) least = std::min(least, distance(p, line));
        return least;
    };
    for (const Point2 p : latticePlaces(plan.limits(), 0.17))
        ASSERT_EQ(validity.isValid(p), free_of_rules.isValid(p) && nearest(lines, p) >= 0.2503 &&
                                           nearest(walls, p) <= 0.6007);
}

/// Returns the plan moved by a displacement.
Environment movedPlan(const std::string& text, Vec2 way) {
    static const Schemas kSchemas(environmentSchemas());
    Document document = readRecordText(text, "plan.env", kSchemas);
    for (Record& record : document.records) placeIn(record, {Point2{} + way, {}});
    return {document.records, assignIds(document.records)};
}

Region movedRegion(Region region, Vec2 way) {
    for (Point2& corner : region.outline) corner = corner + way;
    for (Polygon& hole : region.holes)
        for (Point2& corner : hole) corner = corner + way;
    return region;
}

TEST(Sites, MoveWithThePlan) {
    const Vec2 way{300, -71};
    for (std::uint64_t seed = 1; seed <= kPlans; ++seed) {
        const std::string text = randomPlan(optionsOf(seed));
        const Environment plan = environmentOf(text);
        std::vector<Region> floor = plan.level(kScanHeight)->freeFloor(), moved;
        moved.reserve(floor.size());
        std::vector<Segment2> sheets = plan.slice(kScanHeight).sheets, moved_sheets;
        for (const Segment2& sheet : sheets) moved_sheets.push_back({sheet.a + way, sheet.b + way});
        for (const Region& region : floor) moved.push_back(movedRegion(region, way));
        const auto expect_moved = [&](const std::vector<Point2>& places,
                                      const std::vector<Point2>& others) {
            ASSERT_EQ(places.size(), others.size()) << seed;
            for (std::size_t i = 0; i < places.size(); ++i)
                ASSERT_LT(distance(places[i] + way, others[i]), 1e-9) << seed;
        };
        expect_moved(placesAlong(floor, 0.25, 0.02, sheets),
                     placesAlong(moved, 0.25, 0.02, moved_sheets));
        expect_moved(medialPlaces(floor, 0.25, sheets), medialPlaces(moved, 0.25, moved_sheets));
        const std::vector<Site> sites = wallSites(plan, kScanHeight, 0.05, 3);
        const std::vector<Site> others = wallSites(movedPlan(text, way), kScanHeight, 0.05, 3);
        ASSERT_EQ(sites.size(), others.size());
        for (std::size_t i = 0; i < sites.size(); ++i) {
            ASSERT_LT(distance(sites[i].place + way, others[i].place), 1e-9);
            ASSERT_EQ(sites[i].headings.size(), others[i].headings.size());
            for (std::size_t k = 0; k < sites[i].headings.size(); ++k)
                ASSERT_NEAR(wrapped(sites[i].headings[k] - others[i].headings[k]).degrees(), 0,
                            1e-9);
        }
    }
}

}  // namespace
}  // namespace ispace::testing
