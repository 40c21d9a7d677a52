// SPDX-License-Identifier: GPL-3.0-or-later
// Pixels a metre on the floor, camera by camera and of all together, and axes that are far apart.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "coverage/level_set.h"
#include "coverage/pixel_density.h"
#include "coverage/requirement.h"
#include "coverage/shadow_footprint.h"
#include "geom/predicates.h"
#include "support/test_covering_sensors.h"
#include "support/test_scenes.h"

namespace ispace {
namespace densities_test {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kClasses = 11, kRecognise = 3, kIdentify = 4;

Coverage measured(const std::string& lines, CoverageOptions options = {}) {
    const Scene scene = sceneOf(lines);
    RayScenes worlds(scene.environment);
    if (std::holds_alternative<RoomCells>(options.cells)) options.cells = CellSize{0.05};
    return measureCoverage(scene, worlds, options);
}

constexpr const char* kRoom = "ispace size=12,8,3\n";
const std::string kOfficeCameras =
    std::string(kRoom) +
    "table at=2,1 size=1.4,1.4\ndesk at=-2,1.5 heading=20\ncube at=1,-2 heading=30 "
    "size=0.8,0.6,1.9\nzone id=door path=-5,-3;-3,-3;-3,-1;-5,-1\n"
    "camera id=a at=-5.8,-3.8,2.8 heading=35 tilt=-30 fov=80 pixels=1920,1080\n"
    "camera id=b at=5.8,3.8,2.8 heading=-145 tilt=-25 fov=70 pixels=1280,720\n"
    "camera id=c at=0,0,2.9 tilt=-90 projection=omni fov=180 pixels=1000,1000 range=9\n";

/// Lenses of which the density varies with the direction.
const std::string kBentCameras =
    "camera id=d at=-5.8,3.8,2.6 heading=-35 tilt=-20 fov=95 coefficients=-0.2,0.03,0.002,-0.003 "
    "pixels=1920,1080\n"
    "camera id=e at=5.8,-3.8,2.8 heading=140 tilt=-35 roll=10 projection=fisheye fov=150 "
    "coefficients=-0.03,-0.01,0.002 pixels=1600,1200\n"
    "camera id=f at=0.5,0.5,2.9 tilt=-90 projection=omni mirror=0.9 fov=200 pixels=900,900\n"
    "camera id=g at=-1,3.5,2.7 heading=-80 tilt=-10 fov=70 coefficients=0.25,0.1 pixels=800,600\n";

TEST(Densities, AreasOfClassesAreThoseOfShorterRanges) {
    const Scene scene = sceneOf(kOfficeCameras + kBentCameras);
    const ShadowCaster caster(scene.environment);
    const CoverageReport report = measured(kOfficeCameras + kBentCameras).report;
    ASSERT_EQ(report.sensors.size(), 7U);
    for (std::size_t k = 0; k < report.sensors.size(); ++k) {
        const PictureMetrics& picture = *report.sensors[k].picture;
        ASSERT_EQ(picture.areas.size(), kClasses);
        for (std::size_t i = 0; i < kClasses; ++i) {
            Sensor sensor = scene.sensors[k];
            sensor.model = withDensity(sensor.as<Camera>(), densityClasses()[i].pixels_per_metre);
            const double area = signedArea(caster.regionSeen(sensor, 0).value());
            EXPECT_NEAR(*picture.areas[i].exact, area, 2e-5) << k << ' ' << i;
            EXPECT_NEAR(*picture.areas[i].grid, area, 0.02 * area + 0.05) << k << ' ' << i;
        }
    }
}

/// The floor of a class, against the density of its points.
TEST(Densities, OfLensesEndAtCurves) {
    const std::string empty = "ispace size=30,30,6\n";
    for (const SensorView& view : measured(empty + kBentCameras).sensors) {
        const Scene scene = sceneOf(empty + kBentCameras);
        const Sensor& sensor = scene.sensors[view.index];
        const Camera& camera = sensor.as<Camera>();
        const LensResolution lens(camera);
        const Frame3 frame(sensor.pose);
        std::mt19937_64 random(view.index);
        std::uniform_real_distribution<double> side(-14, 14);
        std::vector<std::vector<Polygon>> regions;
        for (const CoveredSet& set : view.classes) {
            regions.emplace_back();
            for (const Curve& curve : *set.region) regions.back().push_back(chords(curve, 1e-6));
        }
        for (int i = 0; i < 2000; ++i) {
            const double x = side(random);
            const Point2 p{x, side(random)};
            const Vec3 local = frame.toLocal({p.x, p.y, 0});
            const auto pixel = camera.project(local);
            const bool is_in_view = pixel && camera.holds(*pixel);
            const double density = is_in_view ? lens.densityAt(local) : 0;
            for (std::size_t k = 0; k < regions.size(); ++k) {
                const double wanted = densityClasses()[k].pixels_per_metre;
                if (std::fabs(density - wanted) < 1e-4 * wanted) continue;
                bool is_inside = false;
                for (const Polygon& polygon : regions[k])
                    is_inside = is_inside != (locate(polygon, p) == Side::Inside);
                EXPECT_EQ(is_inside, density >= wanted)
                    << view.id << ' ' << p.x << ' ' << p.y << ' ' << density << ' ' << wanted;
            }
        }
    }
}

/// Classes of strongly distorted lenses, against the density at points 4 cm apart: those that no
/// bound of the density cuts, those cut, and those not in view.
TEST(Densities, OfDistortedLensesMatchPoints) {
    std::mt19937_64 random(7);
    const auto uniform = [&random](double low, double high) {
        return std::to_string(std::uniform_real_distribution<double>(low, high)(random));
    };
    std::string lines = "ispace size=12,8,3\n";
    for (int i = 0; i < 20; ++i) {
        lines += "camera at=" + uniform(-5, 5) + ',' + uniform(-3, 3) + ',' + uniform(1.5, 2.9);
        lines += " heading=" + uniform(0, 360) + " tilt=" + uniform(-70, -10);
        lines += " pixels=1600,1200 fx=" + uniform(400, 1200) + " coefficients=";
        lines += uniform(-0.3, 0.2) + ',' + uniform(-0.05, 0.1) + ',' + uniform(-0.03, 0.03) + ',' +
                 uniform(-0.03, 0.03) + '\n';
    }
    const Scene scene = sceneOf(lines);
    int known = 0;
    for (const SensorView& view : measured(lines).sensors) {
        const Sensor& sensor = scene.sensors[view.index];
        const LensResolution lens(sensor.as<Camera>());
        const Frame3 frame(sensor.pose);
        if (!view.region) continue;  // a lens that ends in the picture
        ++known;
        std::vector<Polygon> polygons;
        for (const Curve& curve : *view.region) polygons.push_back(chords(curve, 1e-5));
        constexpr double kStep = 0.04;
        std::vector<double> areas(kClasses);
        for (double x = -6 + kStep / 2; x < 6; x += kStep)
            for (double y = -4 + kStep / 2; y < 4; y += kStep) {
                bool is_seen = false;
                for (const Polygon& polygon : polygons)
                    is_seen = is_seen != (locate(polygon, {x, y}) == Side::Inside);
                if (!is_seen) continue;
                const double density = lens.densityAt(frame.toLocal({x, y, 0}));
                for (std::size_t k = 0; k < kClasses; ++k)
                    if (density >= densityClasses()[k].pixels_per_metre) areas[k] += kStep * kStep;
            }
        for (std::size_t k = 0; k < kClasses; ++k)
            EXPECT_NEAR(signedArea(*view.classes[k].region), areas[k], 0.05) << view.id << ' ' << k;
    }
}

TEST(LevelSets, HaveTheirAreas) {
    const Box2 box{{-5, -5}, {5, 5}};
    const auto area = [&box](auto value) { return signedArea(levelSet(value, box)); };
    const auto far = [](Point2 p, double x, double y) { return std::hypot(p.x - x, p.y - y); };
    EXPECT_NEAR(area([&](Point2 p) { return 3 - far(p, 0.3, 0.2); }), 9 * kPi, 1e-4);
    EXPECT_NEAR(area([&](Point2 p) { return (3 - far(p, 0, 0)) * (far(p, 0, 0) - 1); }), 8 * kPi,
                1e-4);
    // Two discs that touch: no matter how they are joined there.
    EXPECT_NEAR(
        area([&](Point2 p) { return std::max(1.5 - far(p, -1.5, 0), 1.5 - far(p, 1.5, 0)); }),
        2 * 2.25 * kPi, 0.03);
    EXPECT_NEAR(area([&](Point2 p) { return 2 - std::fabs(p.x) - std::fabs(p.y); }), 8, 1e-2);
    EXPECT_EQ(area([](Point2) { return -1.0; }), 0);
    EXPECT_TRUE(levelSet([](Point2) { return 1.0; }, Box2{}).empty());
}

TEST(LevelSets, EndAtTheirBox) {
    const Box2 box{{-1, 2}, {3, 4}};
    EXPECT_NEAR(signedArea(levelSet([](Point2) { return 1.0; }, box)), 8, 0.1);
    const auto half = levelSet([](Point2 p) { return 1e3 * (p.x + p.y - 4); }, box);
    EXPECT_NEAR(signedArea(half), 4, 0.1);
}

/// Barrels fold the picture back within it: their densities fall to 0 at the fold.
TEST(Densities, OfFoldedLensesAreNested) {
    const std::string down =
        "ispace size=12,12,3\ncamera at=0,0,2.8 tilt=-90 fov=80 "
        "coefficients=-0.4,0,0,0 pixels=3840,2160\n";
    const std::string tilted =
        "ispace size=12,12,3\ncamera at=-3,0,2.8 tilt=-45 fov=60 "
        "coefficients=-0.5,0,0,0 pixels=3840,2160\n";
    const std::string turned =
        "ispace size=300,300,9\ncamera at=0,0,8 heading=45 tilt=-20 fov=60 "
        "coefficients=-0.5,0,0,0 pixels=3840,2160\n";
    const auto expect_nested = [](const std::string& lines, double plane, double cell) {
        CoverageOptions options{.plane = plane};
        options.cells = CellSize{cell};
        const SensorMetrics sensor = measured(lines, options).report.sensors.at(0);
        const double view = *sensor.area.exact;
        EXPECT_GT(view, 0.1) << lines;
        double last = view;
        for (const std::size_t i : classesByDensity()) {
            const Metric& area = sensor.picture->areas[i];
            const double error = 4 * cell * std::sqrt(*area.grid) + 4 * cell * cell;
            EXPECT_NEAR(*area.exact, *area.grid, error) << lines << plane << ' ' << i;
            EXPECT_LE(*area.exact, last + 1e-9) << lines << plane << ' ' << i;
            last = *area.exact;
        }
        EXPECT_GT(*sensor.picture->areas[classesByDensity()[0]].exact, 0.9 * view) << lines;
    };
    for (const double plane : {0.0, 1.2, 1.7}) {
        expect_nested(down, plane, 0.05);
        expect_nested(tilted, plane, 0.02);
    }
    expect_nested(turned, 0, 0.2);
}

/// Furniture and walls away from the cameras change no share.
TEST(Densities, NeedTheFloorNearCamerasOnly) {
    std::string lines = "ispace size=60,40,3\nzone id=z path=-20,-12;4,-12;4,-8;-20,-8\n";
    for (int i = 0; i < 60; ++i) {
        const int row = i / 10, column = i % 10;
        const double x = 5.0 * column - 24, y = 6.0 * row - 16;
        const std::string at = std::to_string(x) + "," + std::to_string(y);
        lines.append("table at=").append(at).append(" size=1,1\nwall from=").append(at);
        lines.append(" to=").append(std::to_string(x + 2)).append(",");
        lines.append(std::to_string(y)).append(" height=1\n");
    }
    for (const char* at : {"-20,-11", "2,3.5", "23,14.5"})
        lines += std::string("camera tilt=-40 fov=80 range=6 at=") + at + ",2.5\n";
    const Coverage whole = measured(lines), near = measured(lines, {.whole_densities = false});
    ASSERT_FALSE(near.density_overlays.empty());
    EXPECT_LT(2 * near.density_overlays[0].edges().size(),
              whole.density_overlays[0].edges().size());
    // The same but for the order of sums.
    const auto expect_same = [](const Metric& a, const Metric& b) {
        EXPECT_NEAR(*a.exact, *b.exact, 1e-14);
    };
    expect_same(near.report.densities.seen, whole.report.densities.seen);
    EXPECT_GT(*near.report.densities.seen.exact, 0.01);
    for (std::size_t i = 0; i < kClasses; ++i) {
        expect_same(near.report.densities.indoor[i], whole.report.densities.indoor[i]);
        expect_same(near.report.densities.free[i], whole.report.densities.free[i]);
        expect_same(near.report.zones[0].densities[i], whole.report.zones[0].densities[i]);
    }
    // Only the whole floor has its largest gap.
    const Requirement observed = parseRequirement("observe:99%");
    EXPECT_NE(checkRequirement(observed, whole).text.find("largest"), std::string::npos);
    EXPECT_EQ(checkRequirement(observed, near).text.find("largest"), std::string::npos);
}

TEST(Densities, MeanIsThatOfPlaces) {
    for (const SensorMetrics& sensor : measured(kOfficeCameras + kBentCameras).report.sensors) {
        const PictureMetrics& picture = *sensor.picture;
        EXPECT_NEAR(*picture.mean_density.exact, *picture.mean_density.grid,
                    5e-3 * *picture.mean_density.exact)
            << sensor.id;
    }
    // Straight down a pinhole has the same everywhere.
    const std::string empty = "ispace size=40,40,9\n";
    const PictureMetrics down = *measured(empty + "camera at=0,0,4 tilt=-90 fx=500 pixels=600,400")
                                     .report.sensors[0]
                                     .picture;
    EXPECT_NEAR(*down.mean_density.exact, 125, 1e-9);
    EXPECT_NEAR(*down.areas[kRecognise].exact, 4.8 * 3.2, 1e-5);
    EXPECT_EQ(*down.areas[kIdentify].exact, 0);
    EXPECT_EQ(*down.nearest, 0);
    EXPECT_NEAR(*down.farthest, std::hypot(2.4, 1.6), 1e-6);
    // A fisheye that looks down sees a disc.
    const PictureMetrics disc =
        *measured(empty + "camera at=0,0,3 tilt=-90 projection=omni fov=180 pixels=600,600 range=5")
             .report.sensors[0]
             .picture;
    const double focal = 300 / (kPi / 2);
    EXPECT_NEAR(*disc.mean_density.exact, focal * 2 * (5 - 3) / 16, 1e-3);
    EXPECT_NEAR(*disc.farthest, 4, 1e-6);
    // From 45 degrees: between the rays of the lower and the upper edge, ahead.
    const PictureMetrics ahead =
        *measured(empty + "camera at=0,0,2 tilt=-45 fov=60,40 pixels=600,400")
             .report.sensors[0]
             .picture;
    EXPECT_NEAR(*ahead.nearest, 2 * tanOf(25), 1e-5);
    EXPECT_NEAR(*ahead.farthest,
                std::hypot(2 * tanOf(65), tanOf(30) * (2 * tanOf(65) + 2) * std::sqrt(0.5)), 1e-5);
}

TEST(Densities, OnlyFloorWithEnoughPixelsIsCovered) {
    const double area[] = {
        *measured(kOfficeCameras, {.density = 125}).report.sensors[0].area.exact,
        *measured(kOfficeCameras).report.sensors[0].picture->areas[kRecognise].exact};
    EXPECT_NEAR(area[0], area[1], 2e-5);
    const CoverageReport all = measured(kOfficeCameras).report;
    const CoverageReport some = measured(kOfficeCameras, {.density = 125}).report;
    // Cameras alone are placed, so it is the share of the class; classes stay what they are.
    EXPECT_NEAR(*some.coverage.exact, *all.densities.indoor[kRecognise].exact, 1e-6);
    EXPECT_NEAR(*some.densities.indoor[0].exact, *all.densities.indoor[0].exact, 1e-6);
    EXPECT_NEAR(*some.densities.seen.exact, *some.coverage.exact, 1e-6);
    for (std::size_t i = 0; i < kClasses; ++i) {
        EXPECT_NEAR(*all.densities.indoor[i].exact, *all.densities.indoor[i].grid, 0.01) << i;
        EXPECT_NEAR(*all.densities.free[i].exact, *all.densities.free[i].grid, 0.01) << i;
        EXPECT_NEAR(*all.zones[0].densities[i].exact, *all.zones[0].densities[i].grid, 0.03) << i;
    }
}

TEST(Densities, ManyZonesAreMeasuredInPasses) {
    std::string lines = kOfficeCameras;
    for (int i = 0; i < 60; ++i) {
        const double x = -6 + 0.2 * i;
        lines += "zone path=" + std::to_string(x) + ",-4;" + std::to_string(x + 0.2) + ",-4;" +
                 std::to_string(x + 0.2) + ",4;" + std::to_string(x) + ",4\n";
    }
    const CoverageReport report = measured(lines).report;
    ASSERT_EQ(report.zones.size(), 61U);
    double sum = 0;
    for (std::size_t i = 1; i < 61; ++i)
        sum += *report.zones[i].densities[kRecognise].exact * report.zones[i].area;
    EXPECT_NEAR(sum, *report.densities.indoor[kRecognise].exact * report.indoor_area, 1e-5);
}

TEST(Densities, AreRequired) {
    const Coverage coverage = measured(kOfficeCameras);
    const auto verdict = [&](const char* text) {
        return checkRequirement(parseRequirement(text), coverage);
    };
    EXPECT_TRUE(verdict("monitor:10%").is_met);
    EXPECT_TRUE(verdict("detect:free:10%").is_met);
    const Verdict missing = verdict("identify:door=100%");
    EXPECT_FALSE(missing.is_met);
    EXPECT_EQ(missing.text.find("coverage to identify of zone door is "), 0U) << missing.text;
    EXPECT_NE(missing.text.find("the largest such spot has "), std::string::npos) << missing.text;
    // Without cameras all is missing.
    const Verdict none = checkRequirement(parseRequirement("detect:1%"),
                                          measured(std::string(kRoom) + "laser at=1,1"));
    EXPECT_EQ(none.text.find("coverage to detect is 0.00%"), 0U) << none.text;
    EXPECT_FALSE(none.is_met);
}

TEST(Parallax, IsWhereSoManyAxesAreApart) {
    const auto shares = [](double degrees, int cameras) {
        const Metric metric =
            measured(kOfficeCameras, {.parallax = ParallaxChoice{Angle::degrees(degrees), cameras}})
                .report.parallax_coverage;
        EXPECT_NEAR(*metric.exact, *metric.grid, 0.01) << degrees << ' ' << cameras;
        return *metric.exact;
    };
    const CoverageReport report = measured(kOfficeCameras).report;
    const std::vector<double>& seen = *report.redundancy_exact;
    // Any pair counts at 0 degrees: what two or three see.
    EXPECT_NEAR(shares(0, 2), seen[2] + seen[3], 1e-6);
    EXPECT_NEAR(shares(0, 3), seen[3], 1e-6);
    // Axes a and c are 60 degrees apart, b and c 65, a and b 125.
    EXPECT_NEAR(shares(59, 2), shares(0, 2), 1e-6);
    EXPECT_NEAR(shares(59, 3), seen[3], 1e-6);
    EXPECT_LT(shares(64, 2), shares(59, 2) - 1e-3);
    EXPECT_GT(shares(64, 2), shares(66, 2) + 1e-3);
    EXPECT_GT(shares(66, 2), 0.05);
    EXPECT_EQ(shares(64, 3), 0);
    EXPECT_EQ(shares(126, 2), 0);
    EXPECT_EQ(shares(0, 4), 0);
}

}  // namespace densities_test
}  // namespace ispace
