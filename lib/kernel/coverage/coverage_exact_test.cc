// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics against closed forms, cells, each other and published values.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "base/number.h"
#include "coverage/coverage.h"
#include "coverage/exact_shares.h"
#include "scene/placement_schemas.h"
#include "support/test_scenes.h"

namespace ispace {
namespace coverage_exact_test {

constexpr double kPi = std::numbers::pi;
const std::string kAllAround = "ranger projection=spherical fov=360,180 ";

/// A room with things in it and some lasers, turned and moved as a whole.
std::string randomScene(unsigned seed, int lasers, const Pose2& world_from_room) {
    std::mt19937_64 random(seed);
    const auto within = [&random](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto at = [&world_from_room](double x, double y) {
        const Point2 p = world_from_room * Point2{x, y};
        return formatDouble(p.x) + "," + formatDouble(p.y);
    };
    const auto turned = [&world_from_room](double heading) {
        return formatDouble(heading + world_from_room.heading.degrees());
    };
    std::string text = "fence closed=yes path=" + at(0, 0) + ";" + at(8, 0) + ";" + at(8, 6) + ";" +
                       at(3, 6) + ";" + at(3, 4.5) + ";" + at(0, 4.5) + "\ninside at=" + at(1, 1) +
                       "\nfence path=" + at(5, 0) + ";" + at(5, 2) + "\n";
    for (int i = 0; i < 4; ++i) {
        text += i % 2 == 0 ? "cube" : "cylinder";
        text += " at=" + at(within(1, 7), within(1, 4)) + " heading=" + turned(within(0, 360)) +
                " size=" + formatDouble(within(0.2, 0.9)) + "," + formatDouble(within(0.2, 0.9)) +
                ",1\n";
    }
    for (int i = 0; i < lasers; ++i)
        text += "laser at=" + at(within(0.2, 7.8), within(0.2, 4.3)) +
                " heading=" + turned(within(0, 360)) + " range=" + formatDouble(within(1, 6)) +
                " fov=" + std::to_string(static_cast<int>(within(30, 360))) + "\n";
    return text;
}

double perimeterOf(const Coverage& coverage) {
    double sum = 0;
    for (const SensorView& view : coverage.sensors) sum += perimeter(*view.region);
    return sum;
}

// A door of 1 m in the middle of a wall, open to a floor without end.
Scene openDoor(const std::string& range) {
    return sceneOf(
        "fence id=w path=0,0;6,0;6,4;0,4 closed=yes height=2.5\n"
        "door id=front wall=w at=3,0 size=1,0.2 height=2.1 open=yes\ninside at=1,1\n"
        "laser at=3,3.9,0.3 heading=-90 fov=180 range=" +
        range + "\nlaser at=2,3.9,0.3 heading=-90 fov=180 range=" + range + "\n");
}

TEST(ExactCoverage, FloorBeyondTheLimitsIsAnotherFigure) {
    const Coverage coverage = coverageOf(openDoor("30"), 600, 400);
    const CoverageReport& report = coverage.report;
    for (const auto& [metric, name] : {std::pair(report.total_effective_area, "total"),
                                       {report.overlap, "overlap"},
                                       {report.sensors[0].area, "area"},
                                       {report.sensors[1].area, "other area"},
                                       {report.sensors[0].marginal, "marginal"},
                                       {report.sensors[0].overlap, "shared"}})
        EXPECT_NEAR(*metric.grid, *metric.exact, 0.02) << name;
    EXPECT_NEAR(*report.total_effective_area.exact, *report.coverage.exact * report.indoor_area,
                1e-7);
    EXPECT_NEAR(*report.sensors[0].area.exact, 23.4, 1e-7);
    // Up to the opening, the sector has the opening's width.
    const double width = 2 * std::atan2(0.5, 3.9);
    EXPECT_NEAR(*report.sensors[0].outside, 900 * width / 2 - 0.5 * 3.9, 0.5 * 900 * 1e-3);
    EXPECT_LT(*report.outside, *report.sensors[0].outside + *report.sensors[1].outside);
    EXPECT_GT(*report.outside, *report.sensors[1].outside);
}

// The lattice is that of the room, however far views through the door reach.
TEST(ExactCoverage, DoesNotDependOnTheRange) {
    const CoverageReport near = coverageOf(openDoor("30")).report;
    const CoverageReport far = coverageOf(openDoor("1000000")).report;
    EXPECT_NEAR(*near.coverage.exact, *far.coverage.exact, 1e-9);
    EXPECT_NEAR(*near.total_effective_area.exact, *far.total_effective_area.exact, 1e-8);
    EXPECT_NEAR(*near.sensors[0].area.exact, *far.sensors[0].area.exact, 1e-8);
    EXPECT_GT(*far.outside, 1e10);
    EXPECT_NEAR(*far.coverage.grid, *far.coverage.exact, 0.01);
}

TEST(ExactCoverage, CellsConvergeToIt) {
    for (unsigned seed = 0; seed < 12; ++seed) {
        const Scene scene = sceneOf(randomScene(seed, 3, {}));
        for (const int cells : {40, 160, 640}) {
            const Coverage coverage = coverageOf(scene, cells, cells);
            const CoverageReport& report = coverage.report;
            const Grid& grid = coverage.target.grid;
            const double cell = std::hypot(grid.limits.width(), grid.limits.depth()) / cells;
            const double bound = perimeterOf(coverage) * cell;
            EXPECT_NEAR(*report.total_effective_area.grid, *report.total_effective_area.exact,
                        bound)
                << seed << ' ' << cells;
            const double rim = scene.environment.indoor().boundaryLength() * cell;
            EXPECT_NEAR(*report.coverage.grid, *report.coverage.exact,
                        2 * (bound + rim) / report.indoor_area);
            EXPECT_NEAR(*report.free_coverage.grid, *report.free_coverage.exact,
                        4 * (bound + rim) / report.free_area);
            for (const SensorMetrics& sensor : report.sensors) {
                EXPECT_NEAR(*sensor.area.grid, *sensor.area.exact, bound);
                EXPECT_NEAR(*sensor.marginal.grid, *sensor.marginal.exact, bound);
            }
            for (std::size_t k = 0; k < report.redundancy.size(); ++k)
                EXPECT_NEAR(report.redundancy[k], (*report.redundancy_exact)[k],
                            2 * (bound + rim) / report.indoor_area)
                    << k;
        }
        // Far below the bound where cells are small.
        const CoverageReport fine = coverageOf(scene, 640, 640).report;
        EXPECT_NEAR(*fine.coverage.grid, *fine.coverage.exact, 2e-3) << seed;
    }
}

/// Area that all of some regions hold.
double common(const std::vector<const SensorView*>& views) {
    std::vector<Layer> layers;
    for (const SensorView* view : views) layers.push_back({.curves = *view->region});
    const auto all = static_cast<std::int32_t>(views.size());
    return Overlay(layers).area([all](const LayerLabel& label) { return label.count == all; });
}

TEST(ExactCoverage, UnionIsThatOfInclusionAndExclusion) {
    for (unsigned seed = 20; seed < 60; ++seed) {
        const int lasers = 2 + static_cast<int>(seed % 2);
        const Coverage coverage = coverageOf(sceneOf(randomScene(seed, lasers, {})), 10, 10);
        const std::vector<SensorView>& v = coverage.sensors;
        double sum = 0;
        for (const SensorView& view : v) sum += signedArea(*view.region);
        double expected = sum - common({&v[0], &v[1]});
        if (lasers == 3)
            expected +=
                common({&v[0], &v[1], &v[2]}) - common({&v[0], &v[2]}) - common({&v[1], &v[2]});
        EXPECT_NEAR(*coverage.report.total_effective_area.exact, expected, 1e-6) << seed;
    }
}

TEST(ExactCoverage, MetricsFitTogether) {
    for (unsigned seed = 60; seed < 80; ++seed) {
        const Scene scene = sceneOf(randomScene(seed, 5, {}));
        const CoverageReport report = coverageOf(scene, 10, 10).report;
        double shares = 0, seen = 0;
        for (const double share : *report.redundancy_exact) shares += share;
        EXPECT_NEAR(shares, 1, 1e-9);
        EXPECT_NEAR((*report.redundancy_exact)[0], 1 - *report.coverage.exact, 1e-9);
        // No laser sees into solids or through the outer walls.
        EXPECT_NEAR(*report.total_effective_area.exact, *report.coverage.exact * report.indoor_area,
                    1e-5);
        EXPECT_NEAR(*report.total_effective_area.exact,
                    *report.free_coverage.exact * report.free_area, 1e-5);
        double alone = 0;
        for (const SensorMetrics& sensor : report.sensors) {
            seen += *sensor.area.exact;
            alone += *sensor.marginal.exact;
            EXPECT_NEAR(*sensor.marginal.exact + *sensor.overlap.exact, *sensor.area.exact, 1e-9);
        }
        EXPECT_LE(*report.total_effective_area.exact, seen + 1e-6);
        EXPECT_NEAR(*report.total_effective_area.exact, alone + *report.overlap.exact, 1e-6);
        double unseen = 0;
        for (const UncoveredSpot& spot : report.unseen) {
            unseen += spot.area;
            EXPECT_EQ(scene.environment.indoor().locate(spot.place), Side::Inside);
        }
        EXPECT_NEAR(unseen, (1 - *report.free_coverage.exact) * report.free_area, kMinPiece * 20);
        EXPECT_TRUE(std::is_sorted(
            report.unseen.begin(), report.unseen.end(),
            [](const UncoveredSpot& a, const UncoveredSpot& b) { return a.area > b.area; }));
    }
}

TEST(ExactCoverage, MarginalAreaIsWhatIsLostWithoutTheSensor) {
    for (unsigned seed = 80; seed < 90; ++seed) {
        Scene scene = sceneOf(randomScene(seed, 4, {}));
        const CoverageReport whole = coverageOf(scene, 50, 50).report;
        for (std::size_t i = 0; i < 4; ++i) {
            Scene less = scene;
            less.sensors.erase(less.sensors.begin() + static_cast<std::ptrdiff_t>(i));
            const CoverageReport without = coverageOf(less, 50, 50).report;
            EXPECT_NEAR(*whole.total_effective_area.exact - *without.total_effective_area.exact,
                        *whole.sensors[i].marginal.exact, 1e-6);
            EXPECT_NEAR(*whole.total_effective_area.grid - *without.total_effective_area.grid,
                        *whole.sensors[i].marginal.grid, 1e-9);
        }
    }
}

TEST(ExactCoverage, MovingThePlanChangesNothingButRounding) {
    for (unsigned seed = 100; seed < 115; ++seed) {
        const CoverageReport here = coverageOf(sceneOf(randomScene(seed, 3, {})), 10, 10).report;
        const Pose2 moved{{120.5, -33.25}, Angle::degrees(17.0 * seed)};
        const CoverageReport there =
            coverageOf(sceneOf(randomScene(seed, 3, moved)), 10, 10).report;
        EXPECT_NEAR(*here.coverage.exact, *there.coverage.exact, 1e-6) << seed;
        EXPECT_NEAR(*here.free_coverage.exact, *there.free_coverage.exact, 1e-6);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(*here.sensors[i].area.exact, *there.sensors[i].area.exact, 1e-6);
        EXPECT_EQ(here.pieces, there.pieces) << seed;
    }
}

TEST(ExactCoverage, ClosedForms) {
    const auto report = [](const std::string& lines) { return coverageOf(sceneOf(lines)).report; };
    // A half disc, and a disc, in the open.
    EXPECT_NEAR(*report("ispace size=12,12\nlaser at=0,0 range=4\n").sensors[0].area.exact, 8 * kPi,
                1e-9);
    const CoverageReport disc = report("ispace size=12,12\nlaser at=0,0 range=4 fov=360\n");
    EXPECT_NEAR(*disc.sensors[0].area.exact, 16 * kPi, 1e-9);
    EXPECT_NEAR(*disc.coverage.exact, 16 * kPi / 144, 1e-7);
    // Beams that close the circle leave no wedge, level or not, nor between cells.
    for (const char* const laser : {"first=0 beams=360", "first=-180 beams=800 step=0.45"}) {
        const std::string beams = std::string(" range=4 ") + laser + "\n";
        const CoverageReport around = report("ispace size=12,12\nlaser at=0,0" + beams);
        EXPECT_NEAR(*around.sensors[0].area.exact, 16 * kPi, 1e-9) << laser;
        EXPECT_EQ(around.coverage.grid, disc.coverage.grid) << laser;
        const CoverageReport tilted = report("ispace size=12,12,9\nlaser at=0,0,4 tilt=30" + beams);
        EXPECT_NEAR(*tilted.sensors[0].area.exact, 16 * kPi * std::sqrt(0.75), 1e-3) << laser;
        const CoverageReport full =
            report("ispace size=12,12,9\nlaser at=0,0,4 tilt=30 range=4 fov=360\n");
        EXPECT_EQ(tilted.coverage.grid, full.coverage.grid) << laser;
    }
    // Two discs of radius 2, their middles 2 apart: the lens has 2 r2 acos(d/2r) - d/2
    // sqrt(4r2-d2).
    const CoverageReport two =
        report("ispace size=12,12\nlaser at=-1,0 range=2 fov=360\nlaser at=1,0 range=2 fov=360\n");
    const double lens = 8 * std::acos(0.5) - std::sqrt(12.0);
    EXPECT_NEAR(*two.overlap.exact, lens, 1e-6);
    EXPECT_NEAR(*two.total_effective_area.exact, 8 * kPi - lens, 1e-6);
    EXPECT_NEAR(*two.sensors[0].marginal.exact, 4 * kPi - lens, 1e-6);
    // The shadow of a wall two metres ahead, two metres wide.
    const CoverageReport shadow =
        report("ispace size=8,8\nfence path=2,-1;2,1\nlaser at=0,0 range=20 fov=360\n");
    EXPECT_NEAR(*shadow.coverage.exact, (64.0 - (4 * 2 - 2 * 1)) / 64, 1e-7);
    ASSERT_EQ(shadow.unseen.size(), 1U);
    EXPECT_NEAR(shadow.unseen[0].area, 6, 1e-5);
    EXPECT_GT(shadow.unseen[0].place.x, 2);
}

TEST(ExactCoverage, ZonesAreMeasuredWithinTheRoom) {
    const std::string lines =
        "ispace size=8,8\nlaser at=0,0 range=20\n"  // sees x > 0
        "zone id=half at=0,0 size=2,2\nzone id=seen path=1,1;1,3;3,3;3,1\n"
        "zone id=over at=4,0 size=2,2\nzone id=yard at=20,0 size=1,1\n";
    const CoverageReport report = coverageOf(sceneOf(lines), 200, 200).report;
    ASSERT_EQ(report.zones.size(), 4U);
    EXPECT_NEAR(*report.zones[0].coverage.exact, 0.5, 1e-6);
    EXPECT_NEAR(*report.zones[0].coverage.grid, 0.5, 1e-2);
    EXPECT_NEAR(report.zones[0].area, 4, 1e-6);
    EXPECT_NEAR(*report.zones[1].coverage.exact, 1, 1e-6) << "a zone drawn clockwise";
    EXPECT_NEAR(report.zones[2].area, 2, 1e-6) << "as far as it is in the room";
    EXPECT_EQ(report.zones[3].area, 0);
    EXPECT_EQ(report.zones[3].coverage.exact, 0.0);
    EXPECT_FALSE(report.zones[3].coverage.grid) << "no cell is there";
}

TEST(ExactCoverage, HundredZonesAreMeasuredAsWell) {
    std::string lines = "ispace size=10,10\nlaser at=0,0 range=20\n";
    for (int i = 0; i < 100; ++i)
        lines += "zone at=" + std::to_string(i % 10 - 4.5) + "," + std::to_string(i / 10 - 4.5) +
                 " size=1,1\n";
    const CoverageReport report = coverageOf(sceneOf(lines)).report;
    ASSERT_EQ(report.zones.size(), 100U);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_NEAR(report.zones[i].area, 1, 1e-6) << i;
        EXPECT_NEAR(*report.zones[i].coverage.exact, i % 10 >= 5 ? 1 : 0, 1e-6) << i;
    }
}

TEST(ExactCoverage, WallsPartCoveredFloor) {
    // Two rooms, a sensor in each; with a gap in the wall between they are one piece.
    const std::string room =
        "ispace size=8,4\nlaser at=-2,0 fov=360 range=20\n"
        "laser at=2,0 fov=360 range=20\n";
    const CoverageReport two = coverageOf(sceneOf(room + "fence path=0,-3;0,3\n")).report;
    EXPECT_EQ(two.pieces, 1U) << "a wall across the whole floor parts the room, the sensor outside";
    const CoverageReport open = coverageOf(sceneOf(room + "fence path=0,-2;0,1\n")).report;
    EXPECT_EQ(open.pieces, 1U);
    EXPECT_NEAR(open.largest_piece, 1, 1e-12);
    const CoverageReport apart =
        coverageOf(sceneOf("ispace size=12,4\nlaser at=-4,0 fov=360 range=1\n"
                           "laser at=4,0 fov=360 range=2\n"))
            .report;
    EXPECT_EQ(apart.pieces, 2U);
    EXPECT_NEAR(apart.largest_piece, 0.8, 0.05);
}

TEST(ExactCoverage, AWallBetweenTwoPiecesPartsThem) {
    // Two discs, cut off along the same part of a wall that ends in the room.
    const std::string room =
        "ispace size=8,8\nlaser at=-0.5,0 fov=360 range=1\n"
        "laser at=0.5,0 fov=360 range=1\n";
    EXPECT_EQ(coverageOf(sceneOf(room + "fence path=0,-2;0,2\n")).report.pieces, 2U);
    EXPECT_EQ(coverageOf(sceneOf(room)).report.pieces, 1U);
}

TEST(ExactCoverage, UnseenSpotsHaveArcs) {
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=60,60\nlaser at=0,0 fov=360 range=20\n")).report;
    ASSERT_EQ(report.unseen.size(), 1U);
    EXPECT_NEAR(report.unseen[0].area, 3600 - 400 * kPi, 1e-5);
}

TEST(ExactCoverage, FourReceiversHearTogether) {
    std::string lines = "ispace size=12,12,5\n";
    for (int i = 0; i < 4; ++i) lines += "ultrasound at=0,0,3 tilt=-90 fov=90 range=20\n";
    const CoverageReport four = coverageOf(sceneOf(lines)).report;
    EXPECT_NEAR(*four.total_effective_area.exact, 9 * kPi, 1e-6);
    EXPECT_NEAR(*four.sensors[0].marginal.exact, 9 * kPi, 1e-6);
    EXPECT_NEAR(*four.sensors[0].marginal.grid, 9 * kPi, 0.5);
    EXPECT_EQ(four.redundancy.size(), 2U) << "together they are one";
    const CoverageReport five =
        coverageOf(sceneOf(lines + "ultrasound at=2,0,3 tilt=-90 fov=90 range=20\n")).report;
    EXPECT_GT(*five.total_effective_area.exact, 9 * kPi - 1e-6);
    // What four hear without the first: where the fifth hears, too. Two discs, 2 m apart.
    const double lens = 18 * std::acos(1.0 / 3) - std::sqrt(36.0 - 4);
    EXPECT_NEAR(*five.sensors[0].marginal.exact, 9 * kPi - lens, 1e-5);
    EXPECT_NEAR(*five.sensors[0].marginal.grid, 9 * kPi - lens, 0.5);
    EXPECT_NEAR(*five.sensors[4].marginal.exact, 0, 1e-6);
    EXPECT_EQ(five.sensors[4].marginal.grid, 0.0);
}

TEST(ExactCoverage, OtherSensorsChangeNothingOfWhatOneSees) {
    for (unsigned seed = 200; seed < 210; ++seed) {
        const Scene scene = sceneOf(randomScene(seed, 6, {}));
        const Coverage all = coverageOf(scene);
        for (std::size_t i = 0; i < 6; ++i) {
            Scene one = scene;
            one.sensors = {scene.sensors[i]};
            const Coverage alone = coverageOf(one);
            EXPECT_EQ(alone.sensors[0].cells, all.sensors[i].cells) << seed;
            EXPECT_EQ(alone.report.sensors[0].area.exact, all.report.sensors[i].area.exact);
        }
    }
}

TEST(ExactCoverage, ZonesHaveAreasWithoutExactMetrics) {
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=8,8\nzone id=door at=1,0 size=1,1\n"
                           "laser at=0,0,1 sweep=tilt tilt=-30 sweep_span=20\n"))
            .report;
    EXPECT_NE(report.exact_missing, "");
    EXPECT_NEAR(report.zones[0].area, 1, 1e-9);
    EXPECT_FALSE(report.zones[0].coverage.exact);
}

TEST(GridOfBeams, CellsLieAmongTheEndsOfBeams) {
    const auto report = [](const std::string& laser) {
        const Scene scene = sceneOf("ispace size=12,12\n" + laser);
        RayScenes worlds(scene.environment);
        return measureCoverage(scene, worlds,
                               {.cells = CellCount{400, 400}, .cells_by = CellRule::Beams})
            .report;
    };
    // Five beams over half a turn: four triangles.
    EXPECT_NEAR(*report("laser at=0,0 range=4 fov=180 step=45\n").sensors[0].area.grid,
                4 * 8 * std::sqrt(0.5), 0.1);
    // The beams of a sweep have no outline: their region decides.
    EXPECT_NEAR(*report("laser at=0,0 range=4 fov=10 sweep=heading\n").sensors[0].area.grid,
                16 * kPi, 0.2);
}

TEST(ExactCoverage, LasersAtSeveralHeightsSeeTheirOwnSlice) {
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=8,8\ncube at=2,0 size=0.5,20,0.5\n"
                           "laser at=0,0,0.2 range=20\nlaser at=0,0,1 range=20\n"))
            .report;
    EXPECT_NEAR(*report.sensors[0].area.exact, 1.75 * 8, 1e-6);
    EXPECT_NEAR(*report.sensors[1].area.exact, 4 * 8, 1e-6);
    EXPECT_NEAR(*report.overlap.exact, 1.75 * 8, 1e-6);
}

TEST(ExactCoverage, HeadingSweepsAddUp) {
    // Scans at 0, 1, ... 90 degrees.
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=20,20\n"
                           "laser at=0.03,0 range=4 fov=90 sweep=heading sweep_span=90\n"),
                   200, 200)
            .report;
    EXPECT_NEAR(*report.sensors[0].area.exact, 16 * kPi / 360 * 180, 1e-9);
    EXPECT_NEAR(*report.sensors[0].area.grid, *report.sensors[0].area.exact, 0.3);
}

TEST(Compare, TellsGainAndLoss) {
    const Scene left = sceneOf("ispace size=8,8\nlaser at=0,0 heading=180 range=20\n");
    const Scene all = sceneOf("ispace size=8,8\nlaser at=0,0 fov=360 range=20\n");
    const Scene up = sceneOf("ispace size=8,8\nlaser at=0,0 heading=90 range=20\n");
    Coverage now = coverageOf(up);
    compare(now, coverageOf(left), up.environment.indoor(), "left.3dm");
    ASSERT_TRUE(now.report.comparison);
    EXPECT_NEAR(*now.report.comparison->gained.exact, 16, 1e-5);
    EXPECT_NEAR(*now.report.comparison->lost.exact, 16, 1e-5);
    EXPECT_NEAR(*now.report.comparison->gained.grid, 16, 0.2);
    EXPECT_NEAR(*now.report.comparison->lost.grid, 16, 0.2);
    EXPECT_NEAR(*now.report.comparison->coverage.exact, 0.5, 1e-6);
    compare(now, coverageOf(all), up.environment.indoor(), "all.3dm");
    EXPECT_NEAR(*now.report.comparison->gained.exact, 0, 1e-5);
    EXPECT_NEAR(*now.report.comparison->lost.exact, 32, 1e-5);
}

/// Views that all cross each other end in figures by cells, which say how to get the others.
TEST(CoverageExact, CrowdsOfViewsHaveTheFiguresOfCells) {
    std::string text = "ispace size=40,30\n";
    for (int i = 0; i < 12; ++i)
        for (int k = 0; k < 12; ++k) {
            const std::string at = std::to_string(3 * i - 17) + ',' + std::to_string(2 * k - 11);
            text += (i + k) % 2 == 0 ? "cube at=" + at + " size=0.1\n"
                                     : kAllAround + "range=50 at=" + at + ",2\n";
        }
    const Scene scene = sceneOf(text);
    const auto measured = [&scene](std::optional<std::uint64_t> max_work) {
        CoverageOptions options{.keep_depths = false};
        options.max_work = max_work;
        RayScenes worlds(scene.environment);
        return measureCoverage(scene, worlds, options);
    };
    const Coverage by_cells = measured(150'000), whole = measured(std::nullopt);
    EXPECT_EQ(by_cells.report.exact_missing,
              "outlines cross more than 150000 times (`--max-work 300000` allows more)");
    EXPECT_FALSE(by_cells.overlay);
    EXPECT_FALSE(by_cells.report.coverage.exact);
    ASSERT_TRUE(whole.overlay) << whole.report.exact_missing;
    EXPECT_NEAR(*whole.report.coverage.exact, *by_cells.report.coverage.grid, 1e-3);
    EXPECT_EQ(by_cells.report.sensors.front().area.exact, whole.report.sensors.front().area.exact)
        << "each view by itself is exact";
    const Coverage without_regions = measured(10'000);
    EXPECT_EQ(without_regions.report.exact_missing,
              "outlines of views have more than 2500 edges (`--max-work 20000` allows more)");
    EXPECT_FALSE(without_regions.report.sensors.front().area.exact);
    EXPECT_EQ(without_regions.report.coverage.grid, whole.report.coverage.grid);
}

/// A scene after these edits, which shares the data of its room.
Scene changedBy(const Scene& scene, const std::vector<Edit>& edits) {
    return makeScene(edited(scene.records, edits, sceneSchemas()), scene, DeviceCatalogue());
}

TEST(MeasureChanged, HasTheFiguresOfAMeasureOfTheWhole) {
    const Scene before =
        sceneOf(randomScene(3, 4, {}) + kAllAround + "id=d1 at=1,1,2\n" + kAllAround +
                "id=d2 at=7,1,2\ncamera id=c at=2,2,2 tilt=-40\nzone id=z at=2,2 "
                "size=1,1\n");
    const CoverageOptions options;
    RayScenes worlds(before.environment);
    const Coverage known = measureCoverage(before, worlds, options);
    const std::vector<std::vector<Edit>> changes = {
        {parseEdit(Edit::Kind::Add, kAllAround + "id=d3 at=4,1,2")},
        {parseEdit(Edit::Kind::Rotate, "laser2:30"), parseEdit(Edit::Kind::Delete, "laser1")},
        {parseEdit(Edit::Kind::Set, "c.tilt=-60"), parseEdit(Edit::Kind::Add, "cube at=4,2")}};
    for (const std::vector<Edit>& edits : changes) {
        const Scene after = changedBy(before, edits);
        RayScenes own(after.environment), others(after.environment);
        const Coverage changed = measureChanged(after, own, options, {&before, &known});
        const Coverage whole = measureCoverage(after, others, options);
        EXPECT_EQ(changed.report.coverage.exact, whole.report.coverage.exact);
        EXPECT_EQ(changed.report.coverage.grid, whole.report.coverage.grid);
        EXPECT_EQ(changed.report.zones[0].coverage.exact, whole.report.zones[0].coverage.exact);
        ASSERT_EQ(changed.sensors.size(), whole.sensors.size());
        for (std::size_t i = 0; i < whole.sensors.size(); ++i) {
            EXPECT_EQ(changed.sensors[i].id, whole.sensors[i].id);
            EXPECT_EQ(changed.sensors[i].index, whole.sensors[i].index);
            EXPECT_EQ(changed.sensors[i].cells, whole.sensors[i].cells);
            EXPECT_EQ(changed.sensors[i].classes.size(), whole.sensors[i].classes.size());
        }
    }
}

TEST(MeasureChanged, TakesTheViewsOfSensorsThatStay) {
    const Scene before =
        sceneOf("ispace size=8,6\n" + kAllAround + "id=d1 at=-3,0,2\nlaser id=l1 at=3,0 range=2\n");
    const CoverageOptions options;
    RayScenes worlds(before.environment);
    Coverage known = measureCoverage(before, worlds, options);
    for (const SensorView& view : known.sensors) EXPECT_GT(view.cells.count(), 0U) << view.id;
    for (SensorView& view : known.sensors) view.cells = CellSet(view.cells.size());  // a mark
    const auto cells_of = [&](const std::string& edit, Edit::Kind kind, const std::string& id) {
        const Scene after = changedBy(before, {parseEdit(kind, edit)});
        RayScenes own(after.environment);
        const Coverage changed = measureChanged(after, own, options, {&before, &known});
        for (const SensorView& view : changed.sensors)
            if (view.id == id) return view.cells.count();
        return std::size_t{0};
    };
    EXPECT_EQ(cells_of(kAllAround + "id=d2 at=0,2,2", Edit::Kind::Add, "d1"), 0U);
    EXPECT_EQ(cells_of(kAllAround + "id=d2 at=0,2,2", Edit::Kind::Add, "l1"), 0U);
    EXPECT_GT(cells_of(kAllAround + "id=d2 at=0,2,2", Edit::Kind::Add, "d2"), 0U);
    EXPECT_GT(cells_of("l1.range=1", Edit::Kind::Set, "l1"), 0U);
    EXPECT_EQ(cells_of("l1.range=1", Edit::Kind::Set, "d1"), 0U);
    EXPECT_GT(cells_of("cube at=0,0", Edit::Kind::Add, "l1"), 0U) << "another room";
}

}  // namespace coverage_exact_test
}  // namespace ispace
