// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include "coverage/pixel_density.h"
#include "geom/predicates.h"
#include "report/map/depth_shades.h"
#include "support/test_map.h"

namespace ispace {
namespace map_floor_test {

using namespace palette;

/// The map of a layout in an empty room of 8 m x 8 m, compared with that of another.
std::string comparisonOf(const std::string& now, const std::string& before, bool exact = true,
                         int width = 1200) {
    const Scene scene = sceneOf("ispace size=8,8\n" + now);
    const Scene other_scene = sceneOf("ispace size=8,8\n" + before);
    RayScenes worlds(scene.environment);
    const CoverageOptions options{.exact = exact};
    Coverage coverage = measureCoverage(scene, worlds, options);
    const Coverage other = measureCoverage(other_scene, worlds, options);
    compare(coverage, other, scene.environment.indoor(), "old.3dm");
    return drawCoverageMap(scene, coverage, {PictureFormat::Png, width, ""}, &other);
}

// Sectors of a quarter turn from the middle to the walls.
const std::string kRight = "laser id=right at=0,0 heading=0 fov=90 range=20\n";
const std::string kUp = "laser id=up at=0,0 heading=90 fov=90 range=20\n";
const std::string kUpRight = "laser id=upright at=0,0 heading=45 fov=90 range=20\n";

TEST(MapFloor, RedundancyDarkensTheFloor) {
    const PlanPixels pixels(mapOf("ispace size=8,8\nlaser at=0,-3.99 heading=90 range=20\n"
                                  "laser at=-0.01,0 heading=0 range=20\n"),
                            8);
    EXPECT_EQ(pixels.at(-2, 2), pixelOf(sequentialColor(1, 2)));
    EXPECT_EQ(pixels.at(2, 2), pixelOf(sequentialColor(2, 2)));
}

TEST(MapFloor, ShadesOfManyDepthsAreThoseOfAllDepths) {
    std::string lasers;
    for (int i = 0; i < 60; ++i) {
        const int column = i % 10, row = i / 10;
        lasers += "laser at=" + std::to_string(-3.5 + column * 0.7) + "," +
                  std::to_string(-3 + row * 1.1) + " heading=" + std::to_string(37 * i) +
                  " fov=200 range=2.3\n";
    }
    const Scene scene =
        sceneOf("ispace size=8,8\nwall from=-1,-4 to=-1,1\ncube at=2,2 size=0.5\n" + lasers);
    RayScenes worlds(scene.environment);
    const Coverage all = measureCoverage(scene, worlds, {});
    CoverageOptions options;
    options.keep_depths = false;
    Coverage shaded = measureCoverage(scene, worlds, options);
    addDepthShades(shaded, scene);
    ASSERT_GT(all.report.redundancy_exact->size(), 12U);
    EXPECT_LT(shaded.overlay->edges().size(), all.overlay->edges().size() / 2);
    EXPECT_EQ(drawCoverageMap(scene, shaded, {}), drawCoverageMap(scene, all, {}));
}

TEST(MapFloor, NoSeamsByCellsNorExact) {
    for (const bool exact : {false, true}) {
        const Scene scene = sceneOf("ispace size=8,8\nlaser at=0,0 fov=360 range=20\n");
        RayScenes worlds(scene.environment);
        const Coverage coverage = measureCoverage(scene, worlds, {.exact = exact});
        EXPECT_EQ(coverage.overlay.has_value(), exact);
        const PlanPixels pixels(drawCoverageMap(scene, coverage, {}), 8);
        // A diagonal through many cells, away from marks, rims and walls.
        for (double place = -3.6; place < -0.5; place += 0.01)
            ASSERT_EQ(pixels.at(place, -place), pixelOf(sequentialColor(1, 1))) << place;
    }
}

/// Rooms within rooms: rings, given by their half sides, of which some are indoor.
std::string nested(const std::string& inside) {
    return "ispace id=a size=8,8\nispace id=b size=6,6\nispace id=c size=4,4\n"
           "ispace id=d size=2,2\n" +
           inside;
}

double areaByCurves(const std::vector<Polygon>& curves) {
    // Even-odd, by a fine lattice that no edge runs through.
    constexpr double kStep = 0.05;
    double area = 0;
    for (double x = -4.975; x < 5; x += kStep)
        for (double y = -4.975; y < 5; y += kStep) {
            int around = 0;
            for (const Polygon& curve : curves)
                if (locate(curve, {x, y}) == Side::Inside) ++around;
            if (around % 2 == 1) area += kStep * kStep;
        }
    return area;
}

TEST(MapFloor, OutsideIsWhatLiesInHolesAndIsNoRoom) {
    const auto outside = [](const std::string& inside) {
        return outsideOf(sceneOf(nested(inside)).environment.indoor());
    };
    EXPECT_NEAR(areaByCurves(outside("inside at=3.5,0\n")), 36, 1e-6);
    EXPECT_NEAR(areaByCurves(outside("inside at=3.5,0\ninside at=1.5,0\n")), 24, 1e-6);
    EXPECT_NEAR(areaByCurves(outside("inside at=3.5,0\ninside at=0,0\n")), 32, 1e-6);
    // A room fills the hole, and its own hole is still outside.
    EXPECT_NEAR(areaByCurves(outside("inside at=3.5,0\ninside at=2.5,0\n")), 16, 1e-6);
    // Nothing is outside: neither painted nor named in the legend.
    EXPECT_TRUE(
        outside("inside at=3.5,0\ninside at=2.5,0\ninside at=1.5,0\ninside at=0,0\n").empty());
}

TEST(MapFloor, HolesOfRoomsWithinRoomsAreHatched) {
    const PlanPixels pixels(mapOf(nested("inside at=3.5,0\ninside at=1.5,0\n")), 8);
    EXPECT_EQ(pixels.at(3.5, 0.3), pixelOf(kFloor));
    EXPECT_EQ(pixels.at(1.5, 0.3), pixelOf(kFloor));
    for (const double x : {0.3, 2.5}) {
        int other = 0;
        for (double y = -0.5; y < 0.5; y += 0.01)
            if (pixels.at(x, y) != pixelOf(kFloor)) ++other;
        EXPECT_GT(other, 90) << x;
    }
}

TEST(MapFloor, ExactOutlinesHaveNoSteps) {
    // The left side of the sector runs at 60 degrees; cells are 8 cm wide.
    const PlanPixels pixels(
        mapOf("ispace size=8,8\nlaser at=0,0 heading=30 fov=60 range=20\n", {.width = 2400}), 8);
    const Vec2 along = unitVector(Angle::degrees(60)), left = perpendicular(along);
    for (double away = 0.8; away < 4.2; away += 0.01) {
        const Point2 inside = Point2{} + away * along - 0.02 * left;
        const Point2 outside = Point2{} + away * along + 0.02 * left;
        ASSERT_FALSE(isNear(pixels.at(inside.x, inside.y), kFloor)) << away;
        ASSERT_TRUE(isNear(pixels.at(outside.x, outside.y), kFloor)) << away;
    }
}

TEST(MapFloor, ArcsAreRound) {
    const PlanPixels pixels(
        mapOf("ispace size=8,8\nlaser at=0,0 heading=0 fov=360 range=3\n", {.width = 2400}), 8);
    for (int turn = 0; turn < 360; ++turn) {
        const Vec2 way = unitVector(Angle::degrees(turn + 0.5));
        ASSERT_FALSE(isNear(pixels.at(2.985 * way.x, 2.985 * way.y), kFloor)) << turn;
        ASSERT_TRUE(isNear(pixels.at(3.02 * way.x, 3.02 * way.y), kFloor)) << turn;
    }
}

TEST(MapFloor, SensorsHaveTheirColoursAndShareStripes) {
    const std::string lines = "ispace size=8,8\n" + kRight + kUpRight;
    for (const bool exact : {false, true}) {
        const Scene scene = sceneOf(lines);
        RayScenes worlds(scene.environment);
        const Coverage coverage = measureCoverage(scene, worlds, {.exact = exact});
        const MapOptions options{.color = MapColor::Sensor};
        const MapPicture map{scene, coverage, options};
        const PlanPixels pixels(drawCoverageMap(scene, coverage, options), 8);
        EXPECT_TRUE(isNear(pixels.at(2, -1), floorColor(map, 0)));
        EXPECT_TRUE(isNear(pixels.at(1, 2), floorColor(map, 1)));
        EXPECT_NE(floorColor(map, 0), floorColor(map, 1));
        EXPECT_EQ(pixels.at(-2, -2), pixelOf(kFloor));
        // Where both see, half of the floor has the stripes of each, less their soft sides.
        for (const std::size_t set : {0U, 1U})
            EXPECT_NEAR(pixels.shareOf(stripeColor(map, set), 3, 1.3, 40), 0.45, 0.05) << set;
        EXPECT_EQ(pixels.shareOf(kFloor, 3, 1.3, 40), 0);
    }
}

TEST(MapFloor, ColoursOfSensorsAreLightButDarkerThanUnseenFloor) {
    const Scene scene = sceneOf("ispace size=8,8\n");
    const Coverage coverage = coverageOf(scene);
    const MapOptions options{.color = MapColor::Sensor};
    for (std::size_t set = 0; set < kSeriesColors; ++set) {
        const Color floor = floorColor({scene, coverage, options}, set);
        EXPECT_GT(lightness(floor), 0.7) << set;
        EXPECT_LT(lightness(floor), lightness(kFloor) - 0.07) << set;
        for (std::size_t other = 0; other < set; ++other)
            EXPECT_NE(floor, floorColor({scene, coverage, options}, other));
    }
}

TEST(MapFloor, ManySensorsShareAPlainHatch) {
    std::string lines = "ispace size=8,8\n";
    for (std::size_t i = 0; i <= kMaxStriped; ++i)
        lines += "laser at=0,0 heading=45 fov=90 range=20\n";
    const PlanPixels pixels(mapOf(lines, {.color = MapColor::Sensor}), 8);
    EXPECT_GT(pixels.shareOf(kShared, 2, 2, 40), 0.7);
    EXPECT_GT(pixels.shareOf(kShared, 2, 2, 40) + pixels.shareOf(kSharedHatch, 2, 2, 40), 0.71);
    EXPECT_LT(pixels.shareOf(kShared, 2, 2, 40), 0.95);
    EXPECT_EQ(pixels.at(-2, -2), pixelOf(kFloor));
}

TEST(MapFloor, ComparisonsTellKeptGainedLostAndUnseen) {
    for (const bool exact : {false, true}) {
        const PlanPixels pixels(comparisonOf(kRight + kUp, kUp + kUpRight, exact), 8);
        EXPECT_EQ(pixels.at(3, -1.5), pixelOf(kGained)) << exact;
        EXPECT_EQ(pixels.at(-1, 2.5), pixelOf(kBoth)) << exact;
        EXPECT_EQ(pixels.at(1, 2.5), pixelOf(kBoth)) << exact;
        EXPECT_EQ(pixels.at(2.5, 1), pixelOf(kBoth)) << exact;
        EXPECT_EQ(pixels.at(-2, -2), pixelOf(kFloor)) << exact;
        EXPECT_EQ(pixels.shareOf(kLost, 0, 0, 350), 0) << exact;
    }
    for (const bool exact : {false, true}) {
        const PlanPixels pixels(comparisonOf(kUp, kRight, exact), 8);
        EXPECT_EQ(pixels.at(0.2, 2.5), pixelOf(kGained)) << exact;
        // Most cells are plain; the others have dark lines, and no other colour shows through.
        EXPECT_GT(pixels.shareOf(kLost, 2.8, 0, 40), 0.6) << exact;
        EXPECT_LT(pixels.shareOf(kLost, 2.8, 0, 40), 0.95) << exact;
        EXPECT_EQ(pixels.shareOf(kGained, 2.8, 0, 40), 0) << exact;
        EXPECT_EQ(pixels.shareOf(kBoth, 2.8, 0, 40), 0) << exact;
        EXPECT_LT(pixels.shareOf(kBoth, 0, 0, 350), exact ? 1e-3 : 0.01);  // cells on the diagonal
    }
}

TEST(MapFloor, ComparedWithItselfNothingIsGainedOrLost) {
    const PlanPixels pixels(comparisonOf(kRight + kUpRight, kUpRight + kRight), 8);
    EXPECT_EQ(pixels.shareOf(kGained, 0, 0, 390), 0);
    EXPECT_EQ(pixels.shareOf(kLost, 0, 0, 390), 0);
    EXPECT_GT(pixels.shareOf(kBoth, 0, 0, 390), 0.3);
}

TEST(MapFloor, ComparisonsFallBackToCellsWhereOneIsNotExact) {
    const Scene scene = sceneOf("ispace size=8,8\n" + kRight);
    RayScenes worlds(scene.environment);
    const Coverage exact = measureCoverage(scene, worlds, {});
    const Coverage cells = measureCoverage(scene, worlds, {.exact = false});
    // The same layout: no fringe where steps of cells would leave the exact outline.
    const PlanPixels pixels(drawCoverageMap(scene, exact, {}, &cells), 8);
    EXPECT_EQ(pixels.shareOf(kGained, 0, 0, 390), 0);
    EXPECT_EQ(pixels.shareOf(kLost, 0, 0, 390), 0);
}

TEST(MapFloor, WhatIsNotIndoorIsHatched) {
    const PlanPixels pixels(
        mapOf("fence path=-4,-4;4,-4;4,4;-4,4 closed=yes\ninside at=3,3\n"
              "fence path=-1,-1;1,-1;1,1;-1,1 closed=yes\nlaser at=-3,-3 heading=45\n"),
        8);
    EXPECT_GT(pixels.shareOf(kOutside, 0, 0, 40), 0.7);
    EXPECT_LT(pixels.shareOf(kOutside, 0, 0, 40), 0.95);
}

TEST(MapFloor, ClassesComeFromExactSharesWhereTheyAreKnown) {
    CoverageReport report;
    report.redundancy = {0.5, 0.5, 0};
    EXPECT_EQ(shadesFor(report).count, 1);
    report.redundancy_exact = {0.5, 0.49, 0.01};
    EXPECT_EQ(shadesFor(report).count, 2);
    report.redundancy_exact = {0.5, 0.5, 1e-12};  // rounding makes no class
    EXPECT_EQ(shadesFor(report).count, 1);
    // A page of maps has one scale: a sensor has one colour, however many see floor elsewhere.
    EXPECT_EQ(redundancyScale(report), 1U);
    CoverageReport elsewhere;
    elsewhere.redundancy = {0, 0, 0, 1};
    const Shades shared = shadesFor(report, 3), other = shadesFor(elsewhere);
    EXPECT_EQ(shared.count, other.count);
    EXPECT_EQ(shared.color(1), other.color(1));
    EXPECT_NE(shared.color(1), shadesFor(report).color(1));
    const Shades wide{4, 5};
    EXPECT_EQ(wide.least(1), 1U);
    EXPECT_EQ(wide.least(2), 5U);
    EXPECT_EQ(wide.of(wide.least(2)), 2);
    EXPECT_EQ(wide.of(wide.least(2) - 1), 1);
}

const Box2 kBox{{0, 0}, {4, 2}};

TEST(MapCurves, ClipKeepsWhatIsInsideAsItIs) {
    const Polygon inside = {{1, 1}, {2, 1}, {1.5, 1.5}};
    EXPECT_EQ(clipped(inside, kBox), inside);
    EXPECT_TRUE(clipped(Polygon{}, kBox).empty());
    EXPECT_TRUE(clipped(Polygon{{5, 0}, {6, 0}, {6, 1}}, kBox).empty());
}

TEST(MapCurves, ClipCutsAtTheSidesWhateverTheTurn) {
    const Polygon square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    EXPECT_DOUBLE_EQ(signedArea(clipped(square, kBox)), 1);
    EXPECT_DOUBLE_EQ(signedArea(clipped(Polygon(square.rbegin(), square.rend()), kBox)), -1);
    const Polygon around = {{-9, -9}, {9, -9}, {9, 9}, {-9, 9}};
    EXPECT_DOUBLE_EQ(signedArea(clipped(around, kBox)), 8);
    // A comb that leaves the box and comes back twice.
    const Polygon comb = {{1, 1}, {1, 5},   {2, 5},   {2, 1}, {3, 1},
                          {3, 5}, {3.5, 5}, {3.5, 0}, {1, 0}};
    EXPECT_DOUBLE_EQ(signedArea(clipped(comb, kBox)), -(2 + 1 + 1));
}

TEST(MapCurves, ClipOfRandomTrianglesHoldsTheSamePlaces) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-4, 8);
    for (int round = 0; round < 300; ++round) {
        Polygon triangle(3);
        for (Point2& p : triangle) p = {place(random), place(random)};
        const Polygon part = clipped(triangle, kBox);
        for (const Point2& p : part) {
            ASSERT_GE(p.x, 0);
            ASSERT_LE(p.x, 4);
            ASSERT_GE(p.y, 0);
            ASSERT_LE(p.y, 2);
        }
        for (int k = 0; k < 20; ++k) {
            const Point2 p{place(random) / 2 + 1, place(random) / 4};
            const bool in_box = p.x > 0 && p.x < 4 && p.y > 0 && p.y < 2;
            const bool wanted = in_box && locate(triangle, p) == Side::Inside;
            ASSERT_EQ(!part.empty() && locate(part, p) == Side::Inside, wanted) << round;
        }
    }
}

TEST(MapCurves, SegmentsAreCutOrDropped) {
    EXPECT_EQ(clipped(Segment2{{-1, 1}, {9, 1}}, kBox), (Segment2{{0, 1}, {4, 1}}));
    EXPECT_EQ(clipped(Segment2{{1, 1}, {1, 9}}, kBox), (Segment2{{1, 1}, {1, 2}}));
    EXPECT_EQ(clipped(Segment2{{1, 1}, {2, 1}}, kBox), (Segment2{{1, 1}, {2, 1}}));
    EXPECT_FALSE(clipped(Segment2{{-1, 3}, {9, 3}}, kBox));
    EXPECT_FALSE(clipped(Segment2{{-2, 1}, {1, 4}}, kBox));
    const auto far = clipped(Segment2{{1, 1}, {1 + 3e9, 1 + 1e9}}, kBox);  // keeps its direction
    ASSERT_TRUE(far);
    EXPECT_NEAR(far->b.x, 4, 1e-6);
    EXPECT_NEAR(far->b.y, 2, 1e-6);
}

TEST(MapCurves, WhatIsFarOffThePlanIsCutBeforeItIsDrawn) {
    const Scene scene = sceneOf("ispace size=8,8\n");
    const Coverage coverage = coverageOf(scene);
    const MapOptions options;
    const MapPicture map{scene, coverage, options, nullptr, 10, {100, {}, {}}};
    // A cone from the room to far outside: its sides keep their directions.
    const std::vector<Polygon> cone = {{{0, 0}, {3e9, 1e9}, {1e9, 3e9}}};
    const std::vector<Polygon> drawn = drawable(map, cone);
    ASSERT_EQ(drawn.size(), 1U);
    EXPECT_LT(bounds(drawn[0]).high.x, 5);
    EXPECT_EQ(locate(drawn[0], {3, 1.01}), Side::Inside);
    EXPECT_EQ(locate(drawn[0], {3, 0.99}), Side::Outside);
    EXPECT_TRUE(drawable(map, std::vector<Polygon>{{{9, 9}, {10, 9}, {10, 10}}}).empty());
}

TEST(MapCurves, ThinnedLinesStayNear) {
    std::mt19937_64 random(8);
    std::normal_distribution<double> step(0, 1);
    for (const double tolerance : {1.0, 3.0}) {
        std::vector<Point2> line = {{0, 0}};
        for (int i = 0; i < 500; ++i)
            line.push_back({line.back().x + 1 + 0.1 * step(random), line.back().y + step(random)});
        const std::vector<Point2> thin = thinned(line, tolerance);
        EXPECT_LT(thin.size(), line.size() / 2);
        EXPECT_EQ(thin.front(), line.front());
        EXPECT_EQ(thin.back(), line.back());
        for (const Point2& p : line) {
            double nearest = 1e9;
            for (std::size_t i = 1; i < thin.size(); ++i)
                nearest = std::min(nearest, distance(p, Segment2{thin[i - 1], thin[i]}));
            ASSERT_LE(nearest, tolerance);
        }
    }
    EXPECT_EQ(thinned({{0, 0}, {1, 0}, {2, 0}}, 0.1), (std::vector<Point2>{{0, 0}, {2, 0}}));
}

/// A closed curve about a place, round but for its noise.
Polygon roundCurve(std::mt19937_64& random, Point2 middle, double radius, int corners) {
    std::uniform_real_distribution<double> noise(0.97, 1.03);
    Polygon curve;
    for (int i = 0; i < corners; ++i) {
        const Angle way = Angle::degrees(360.0 * i / corners);
        curve.push_back(middle + noise(random) * radius * unitVector(way));
    }
    return curve;
}

TEST(MapCurves, FittedCurvesHaveFewCornersAndStayNear) {
    std::mt19937_64 random(5);
    std::vector<Polygon> curves = {roundCurve(random, {0, 0}, 10, 3000),
                                   roundCurve(random, {30, 0}, 4, 900)};
    for (int i = 0; i < 20; ++i) curves.push_back(roundCurve(random, {-30.0, 5.0 * i}, 0.05, 12));
    double last = 1e9;
    for (const std::size_t most : {20U, 80U, 600U}) {
        const FittedCurves fit = fitted(curves, most);
        EXPECT_LE(cornersOf(fit.curves), most);
        EXPECT_GT(cornersOf(fit.curves), most / 2);
        EXPECT_GT(fit.tolerance, 0);
        EXPECT_LT(fit.tolerance, last);
        last = fit.tolerance;
        ASSERT_GE(fit.curves.size(), 2U);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_GT(signedArea(fit.curves[i]), 0);
            for (const Point2 p : curves[i]) {
                double nearest = 1e9;
                forEachEdge(fit.curves[i], [&](const Segment2& edge) {
                    nearest = std::min(nearest, distance(p, edge));
                });
                ASSERT_LE(nearest, fit.tolerance + 1e-12);
            }
        }
    }
    // Small ones are left out first.
    EXPECT_EQ(fitted(curves, 20).curves.size(), 2U);
    EXPECT_EQ(fitted(curves, 6000).curves, curves);
    EXPECT_EQ(fitted(curves, 6000).tolerance, 0);
    EXPECT_TRUE(fitted({}, 5).curves.empty());
    // Curves without extent have no corner to keep.
    EXPECT_TRUE(fitted({Polygon(9, Point2{1, 1})}, 5).curves.empty());
}

TEST(DensityMap, IsColouredByClass) {
    const std::string lines =
        "ispace size=8,8,3\ncamera at=-3.9,0,2 tilt=-20 fov=90 pixels=640,480\n";
    const Scene scene = sceneOf(lines);
    const Coverage coverage = coverageOf(scene);
    MapOptions options;
    options.color = MapColor::Density;
    const PlanPixels plan(drawCoverageMap(scene, coverage, options), 8);
    const FloorDensity density(scene.sensors[0].as<Camera>(), scene.sensors[0].pose, 0);
    for (const Point2 place : {Point2{-1.3, 0.9}, {0.4, 1.7}, {2.9, 2.5}}) {
        std::size_t index = 0;
        while (index < pixelDensities().size() &&
               density.at(place) >= pixelDensities()[index].pixels_per_metre)
            ++index;
        EXPECT_GT(plan.shareOf(densityColor(index), place.x, place.y, 3), 0.6) << place.x;
    }
    EXPECT_GT(plan.shareOf(palette::kFloor, -3.4, 3.2, 3), 0.6);
}

}  // namespace map_floor_test
}  // namespace ispace
