// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/camera_rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"
#include "coverage/visible_area.h"
#include "extensions/camerarules/facing_meter.h"
#include "scene/sensor/camera.h"
#include "support/test_scenes.h"

namespace ispace::camerarules {
namespace camera_rules_test {

const std::string kTwoZones =
    "ispace size=10,8,3\nzone id=door path=-1,-1;1,-1;1,1;-1,1\nzone id=desk1 "
    "path=3,-4;5,-4;5,-2;3,-2\n"
    "zone id=desk2 path=-5,-4;-4,-4;-4,-3;-5,-3\n";
/// Looks down and sees all of the room.
std::string domeAt(const std::string& id, const std::string& at) {
    return "camera id=" + id + " at=" + at +
           ",2.9 tilt=-90 projection=omni fov=179 pixels=2000,2000 range=30\n";
}

Coverage measuredFor(const Scene& scene, double density = 0) {
    RayScenes worlds(scene.environment);
    CoverageOptions options;
    options.cells = CellSize{0.25};
    options.density = density;
    return measureCoverage(scene, worlds, options);
}

double facing(const std::string& lines, const char* rule) {
    const Scene scene = sceneOf(lines);
    const std::vector<FacingRule> rules = {parseFacing(rule)};
    const auto results = measureFacing(scene, measuredFor(scene), rules);
    EXPECT_EQ(results.size(), 1U);
    EXPECT_NEAR(results.front().area, 4, 1e-6);
    return results.front().share.value();
}

TEST(CameraRules, ParseFacingAndPrivacy) {
    const FacingRule rule = parseFacing("zone:a,b,45deg,180=90%");
    EXPECT_EQ(rule.zone, "a,b");
    EXPECT_NEAR(rule.within.degrees(), 45, 1e-12);
    EXPECT_NEAR(rule.heading.degrees(), 180, 1e-12);
    EXPECT_EQ(rule.required, 0.9);
    EXPECT_FALSE(rule.is_by_doors);
    const FacingRule by_doors = parseFacing("a,b,45deg=90%");
    EXPECT_EQ(by_doors.zone, "a,b");
    EXPECT_NEAR(by_doors.within.degrees(), 45, 1e-12);
    EXPECT_TRUE(by_doors.is_by_doors);
    for (const char* text : {"", "a,x", ",45deg", ",45deg,0", "a,0deg,0", "a,181deg,0", "a,x,0",
                             "a,45deg,0=x", "a,45deg,1e9"})
        EXPECT_ANY_THROW(parseFacing(text)) << text;
    const FacingRule plain = parseFacing("entrance=90%");
    EXPECT_EQ(plain.zone, "entrance");
    EXPECT_NEAR(plain.within.degrees(), 45, 1e-12);
    EXPECT_TRUE(plain.is_by_doors);
    EXPECT_EQ(plain.required, 0.9);
    EXPECT_EQ(parsePrivacy("zone:desk*").zones, "desk*");
    EXPECT_EQ(parsePrivacy("desk*").density, 0);
    EXPECT_EQ(parsePrivacy("desk*,recognise").density, 125);
    EXPECT_EQ(parsePrivacy("desk*,80").density, 80);
    for (const char* text : {"", "zone:", "desk,often"})
        EXPECT_THROW(parsePrivacy(text), UsageError) << text;
}

TEST(CameraRules, HeadingsFollowFromTheDoorsOfAZone) {
    // A door in the north wall, one in the east wall, and one between the two halves of a zone.
    const std::string room =
        "fence id=f path=-4,-3;4,-3;4,3;-4,3 closed=yes\nwall id=w from=0,-3 to=0,0\n"
        "door id=north from=-2.5,3 to=-1.5,3\ndoor id=east from=4,1.5 to=4,2.5\n"
        "door id=within from=0,-2.5 to=0,-1.5\n"
        "zone id=entrance path=-3,1.5;-1,1.5;-1,2.9;-3,2.9\nzone id=corner "
        "path=-3,1;4,1;4,3;-3,3\nzone id=south path=-3,-3;3,-3;3,-1;-3,-1\n"
        "zone id=left path=-3,-3;-0.1,-3;-0.1,-1;-3,-1\n";
    const Scene scene = sceneOf(room);
    const auto headings = [&](const char* zone) {
        std::vector<double> all;
        const FacingRule rule = parseFacing(std::string(zone) + ",45deg");
        for (const FacingRule& own : facingIn(scene.environment, {&rule, 1}))
            all.push_back(std::round(own.heading.degrees()));
        return all;
    };
    EXPECT_EQ(headings("entrance"), std::vector<double>{-90});
    EXPECT_EQ(headings("corner"), (std::vector<double>{-90, 180}));
    EXPECT_EQ(headings("left"), std::vector<double>{180});
    EXPECT_THROW(headings("south"), UsageError);  // floor on both sides
    EXPECT_THROW(headings("bed"), UsageError);
    const Angle south = Angle::degrees(-90), within = Angle::degrees(45);
    EXPECT_TRUE(isFaced(south, within, {-2, 2}, {-2, 0}));
    EXPECT_TRUE(isFaced(south, within, {-2, 2}, {-1, 1}));
    EXPECT_FALSE(isFaced(south, within, {-2, 2}, {-0.9, 1}));
    EXPECT_FALSE(isFaced(south, within, {-2, 2}, {-2, 3}));
}

TEST(CameraRules, ParsesFacingAtDoors) {
    const auto parsed = [](const char* text) {
        const FacingRule rule = parseFacing(text);
        return rule.zone + ' ' + std::to_string(std::lround(rule.within.degrees())) +
               (rule.is_by_doors ? "" : ' ' + std::to_string(std::lround(rule.heading.degrees())));
    };
    EXPECT_EQ(parsed("door:*"), "door:*,1.5 45");
    EXPECT_EQ(parsed("door:Front*,60deg"), "door:Front*,1.5 60");
    EXPECT_EQ(parsed("zone:door:Front*,80cm=50%"), "door:Front*,0.8 45");
    EXPECT_EQ(parsed("door:f,2,30"), "door:f,2 30");
    EXPECT_EQ(parsed("door:f,2m,30deg,180"), "door:f,2 30 180");
    EXPECT_EQ(parsed("door:f,30deg,-90"), "door:f,1.5 30 -90");
    try {
        parsed("door:*,identify");
        ADD_FAILURE() << "a density is an angle";
    } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("asked for by --density identify"),
                  std::string::npos)
            << error.what();
    }
    for (const char* text : {"door:f,1.5", "door:f,x", "door:f,1,2,3,4", "door:f,1,0deg"})
        EXPECT_THROW(parsed(text), UsageError) << text;
}

TEST(CameraRules, ADoorIsOneRuleOfTheFloorAtItsIndoorSides) {
    // The wall of the door `within` stands in the room; people come in by `north`.
    const std::string room =
        "fence id=f path=-4,-3;4,-3;4,3;-4,3 closed=yes\nwall id=w from=0,-3 to=0,0\n"
        "door id=north from=-2.5,3 to=-1.5,3\ndoor id=within from=0,-2.5 to=0,-1.5\n";
    const Scene scene = sceneOf(room);
    const FacingRule any = parseFacing("door:*,0.4,45deg");
    const std::vector<FacingRule> rules = facingIn(scene.environment, {&any, 1});
    ASSERT_EQ(rules.size(), 2U);
    EXPECT_EQ(rules[0].zone, "door:north,0.4");
    ASSERT_EQ(rules[0].parts.size(), 1U);
    EXPECT_NEAR(rules[0].parts[0].heading.degrees(), -90, 1e-9);
    ASSERT_EQ(rules[1].parts.size(), 2U);
    EXPECT_NEAR(std::abs(rules[1].parts[0].heading.degrees() - rules[1].parts[1].heading.degrees()),
                180, 1e-9);
    // Half of a stadium of 1 m by 0.4 m; both halves of the other, without its wall.
    const auto alone = measureFacing(scene, measuredFor(scene), {&any, 1});
    const double pi = std::acos(-1);
    EXPECT_NEAR(alone[0].area, 0.4 + 0.08 * pi, 0.002);
    EXPECT_EQ(alone[0].share, 0);
    // A camera south of the door sees those that come in; one in the north corner sees none.
    const auto share = [&](const std::string& at) {
        const Scene seen = sceneOf(room + domeAt("c", at));
        return measureFacing(seen, measuredFor(seen), {&any, 1}).front().share.value();
    };
    EXPECT_NEAR(share("-2,-1"), 1, 1e-6);
    EXPECT_NEAR(share("-3.9,2.9"), 0, 1e-6);
}

TEST(FacingMeter, MeasuresMovedCamerasAsAnew) {
    std::string room =
        "fence id=f path=-4,-3;4,-3;4,3;-4,3 closed=yes\nwall id=w from=0,-3 to=0,0\n"
        "door id=north from=-2.5,3 to=-1.5,3\ndoor id=within from=0,-2.5 to=0,-1.5\n"
        "zone id=desk path=2,1;3,1;3,2;2,2\n";
    for (const char* at : {"-3,-2", "3,-2", "3,2"})
        room += std::string("camera at=") + at + ",2.4 heading=40 tilt=-40 pixels=640,480 fov=70\n";
    const Scene scene = sceneOf(room);
    const VisibleArea sight(scene.environment, 0);
    std::vector<SensorView> views = measuredFor(scene).sensors;
    const std::vector<FacingRule> rules = {parseFacing("door:*,1m,45deg"),
                                           parseFacing("desk,60deg,180")};
    FacingMeter meter(scene.environment, rules);
    std::mt19937_64 random(7);
    std::set<double> shares;
    for (int i = 0; i < 60; ++i) {
        Sensor moved = scene.sensors[random() % 3];
        SensorView& view = views[random() % 3];
        moved.pose.heading = Angle::degrees(static_cast<double>(random() % 360));
        moved.pose.position.x = -3.5 + 0.1 * static_cast<double>(random() % 70);
        view.pose = moved.pose;
        view.region.reset();
        if (i % 13 != 12)
            if (auto region = sight.regionOf(moved)) view.region = std::move(*region);
        const auto kept = meter.measure(views);
        const auto anew = FacingMeter(scene.environment, rules).measure(views);
        ASSERT_EQ(kept.size(), 3U);
        for (std::size_t k = 0; k < kept.size(); ++k) {
            EXPECT_EQ(kept[k].area, anew[k].area) << i;
            EXPECT_EQ(kept[k].share, anew[k].share) << i;
            if (kept[k].share) shares.insert(*kept[k].share);
        }
    }
    EXPECT_GT(shares.size(), 20U);
}

TEST(CameraRules, UnknownDoorsAndZonesAreListed) {
    const Scene scene = sceneOf(
        "fence id=f path=-4,-3;4,-3;4,3;-4,3 closed=yes\ndoor id=north from=-2.5,3 to=-1.5,3\n"
        "zone id=hall path=-3,1;3,1;3,2;-3,2\n");
    const auto refusal = [&](const char* text) -> std::string {
        const FacingRule rule = parseFacing(text);
        try {
            static_cast<void>(facingIn(scene.environment, {&rule, 1}));
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refusal("door:Front*"), "the room has no door `Front*`; its doors: north (1.00 m)");
    EXPECT_EQ(refusal("lobby,45deg"), "the room has no zone `lobby`; its zones: hall");
    EXPECT_EQ(refusal("nor*,45deg"),
              "the room has no zone `nor*`; its doors of this name: door:nor*; its zones: hall");
    EXPECT_EQ(refusal("north,45deg"),
              "the room has no zone `north`; its doors of this name: door:north; its zones: hall");
}

TEST(CameraRules, FacesAreSeenFromAhead) {
    // People walk east; a camera far east sees all faces, one in the west none.
    EXPECT_NEAR(facing(kTwoZones + domeAt("e", "4.9,0"), "door,45deg,0"), 1, 1e-6);
    EXPECT_NEAR(facing(kTwoZones + domeAt("w", "-4.9,0"), "door,45deg,0"), 0, 1e-6);
    EXPECT_NEAR(facing(kTwoZones + domeAt("w", "-4.9,0"), "door,45deg,180"), 1, 1e-6);
    // Straight above the middle: a quarter of the square lies within 45 degrees to the west.
    EXPECT_NEAR(facing(kTwoZones + domeAt("m", "0,0"), "door,45deg,0"), 0.25, 1e-6);
    EXPECT_NEAR(facing(kTwoZones + domeAt("m", "0,0"), "door,90deg,90"), 0.5, 1e-6);
    EXPECT_NEAR(facing(kTwoZones + domeAt("m", "0,0"), "door,135deg,0"), 0.75, 1e-6);
    EXPECT_NEAR(facing(kTwoZones + domeAt("m", "0,0"), "door,180deg,17"), 1, 1e-6);
    // Two cameras add up: the wedges of both sides of the middle.
    EXPECT_NEAR(facing(kTwoZones + domeAt("m", "0,0") + domeAt("n", "0,0"), "door,45deg,0"), 0.25,
                1e-6);
    EXPECT_NEAR(facing(kTwoZones + domeAt("m", "0,0") + domeAt("e", "4.9,0"), "door,45deg,0"), 1,
                1e-6);
    EXPECT_EQ(facing(kTwoZones, "door,45deg,0"), 0);  // no camera
}

TEST(CameraRules, FacingSharesMatchPoints) {
    const std::string lines = kTwoZones + "pillar at=0.4,0.5 size=0.3,0.3\n" + domeAt("a", "2,3") +
                              domeAt("b", "-1.2,0.3");
    const Scene scene = sceneOf(lines);
    const Coverage coverage = measuredFor(scene);
    const std::vector<FacingRule> rules = {parseFacing("door,50deg,70")};
    const double share = measureFacing(scene, coverage, rules).front().share.value();
    // Without the pillar's shadows it would be larger; count points of the views.
    int inside = 0, all = 0;
    RayScenes worlds(scene.environment);
    CoverageOptions options;
    options.cells = CellSize{0.02};
    const Coverage fine = measureCoverage(scene, worlds, options);
    const Grid& grid = fine.target.grid;
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
        const Point2 p = grid.center(cell);
        if (std::abs(p.x) > 1 || std::abs(p.y) > 1) continue;
        ++all;
        bool is_faced = false;
        for (const SensorView& view : fine.sensors) {
            const Vec2 way = view.pose.position.onFloor() - p;
            const double off =
                wrapped(Angle::radians(std::atan2(way.y, way.x)) - Angle::degrees(70)).degrees();
            is_faced |= view.cells.test(cell) && std::abs(off) <= 50;
        }
        inside += is_faced ? 1 : 0;
    }
    EXPECT_NEAR(share, static_cast<double>(inside) / all, 0.01);
    EXPECT_GT(share, 0.2);
    EXPECT_LT(share, 0.9);
}

TEST(CameraRules, RequiredFacingIsJudged) {
    const Scene scene = sceneOf(kTwoZones + domeAt("m", "0,0"));
    const Coverage coverage = measuredFor(scene);
    const std::vector<FacingRule> rules = {parseFacing("door,45deg,0=25%"),
                                           parseFacing("door,45deg,0=26%")};
    const auto results = measureFacing(scene, coverage, rules);
    EXPECT_TRUE(isMet(results[0]));
    EXPECT_FALSE(isMet(results[1]));
    const std::vector<FacingRule> unknown = {parseFacing("dor,45deg,0")};
    EXPECT_THROW(measureFacing(scene, coverage, unknown), UsageError);
}

TEST(CameraRules, PrivacyIsSightOfTheZone) {
    const Scene scene = sceneOf(kTwoZones + domeAt("m", "0,0") +
                                "laser id=l at=4,-3 fov=360\n"
                                "camera id=away at=4.9,3.9,2.8 heading=180 tilt=-10 fov=40\n");
    const std::vector<PrivacyRule> rules = {parsePrivacy("zone:desk*"),
                                            parsePrivacy("desk*,100000")};
    const auto results = measurePrivacy(scene, 0, rules);
    ASSERT_EQ(results.size(), 4U);
    EXPECT_EQ(results[0].zone, "desk1");
    EXPECT_NEAR(results[0].area, 4, 1e-6);
    EXPECT_NEAR(results[0].seen.value(), 4, 1e-6);
    EXPECT_EQ(results[0].cameras, std::vector<std::string>{"m"});
    EXPECT_FALSE(isMet(results[0]));
    EXPECT_NEAR(results[1].area, 1, 1e-6);
    // No part of the picture has so many pixels a metre.
    EXPECT_EQ(results[2].seen.value(), 0);
    EXPECT_TRUE(results[2].cameras.empty());
    EXPECT_TRUE(isMet(results[2]));
    const std::vector<PrivacyRule> unknown = {parsePrivacy("bed*")};
    EXPECT_THROW(measurePrivacy(scene, 0, unknown), UsageError);
}

// The lattice of unions is that of the zone, however far the camera sees through the open door.
TEST(CameraRules, PrivacyDoesNotDependOnTheRange) {
    const auto seen = [](const std::string& range) {
        const Scene scene = sceneOf(
            "fence id=w path=0,0;6,0;6,4;0,4 closed=yes height=2.5\n"
            "door wall=w at=3,0 size=1,0.2 height=2.1 open=yes\ninside at=1,1\n"
            "zone id=desk path=1,0.5;4.3,0.7;3.9,2.9;1.2,3\n"
            "camera id=c at=3,3.9,2 heading=-97 tilt=-35 fov=50 pixels=800,600 range=" +
            range + '\n');
        const std::vector<PrivacyRule> rules = {parsePrivacy("desk")};
        return measurePrivacy(scene, 0, rules).front().seen.value();
    };
    EXPECT_GT(seen("30"), 0.5);
    EXPECT_NEAR(seen("1000000"), seen("30"), 1e-7);
}

TEST(CameraRules, PrivacyOfALevelIsTheViewAtItsDensity) {
    const std::string lines =
        kTwoZones + "camera id=c at=0,3.9,2.8 heading=-60 tilt=-30 fov=80 pixels=1280,720\n";
    const Scene scene = sceneOf(lines);
    for (const double density : {25.0, 125.0, 200.0}) {
        const std::vector<PrivacyRule> rules = {{"desk1", density}};
        const auto result = measurePrivacy(scene, 0, rules).front();
        const Coverage limited = measuredFor(scene, density);
        EXPECT_NEAR(result.seen.value() / result.area,
                    limited.report.zones[1].coverage.exact.value(), 1e-6)
            << density;
    }
}

}  // namespace camera_rules_test
}  // namespace ispace::camerarules
