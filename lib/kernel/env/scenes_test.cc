// SPDX-License-Identifier: GPL-3.0-or-later
// The scenes of share/scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/file.h"
#include "geom/predicates.h"
#include "record/yaml/yaml.h"
#include "support/test_paths.h"
#include "support/test_scene.h"

namespace ispace {
namespace scenes_test {

using testing::environment;
using testing::schemas;

std::string sceneFile(const std::string& name) {
    return testing::sourcePath("share/scenes/") + name;
}

Environment scene(const std::string& name) {
    const std::string bytes = readAll(sceneFile(name));
    const Document document = name.ends_with(".yaml") ? readYaml(bytes, name, schemas())
                                                      : readRecordText(bytes, name, schemas());
    EXPECT_TRUE(document.history.empty()) << name << ": its comments read as history";
    return environment(document.records);
}

double footprintArea(const Environment& env, std::span<const Polygon> footprints) {
    return env.indoor().area() - totalArea(difference(env.indoor(), footprints));
}

class Scenes : public ::testing::TestWithParam<const char*> {};

TEST_P(Scenes, ThingsStandClearOfEachOtherAndLeaveMostOfTheFloor) {
    const Environment env = scene(GetParam());
    std::vector<Polygon> all;
    double sum = 0;
    for (const Element& element : env.elements()) {
        std::vector<Polygon> own;
        for (const Prism& prism : element.body.prisms) own.push_back(prism.footprint);
        if (own.empty()) continue;
        sum += footprintArea(env, own);
        all.insert(all.end(), own.begin(), own.end());
    }
    const double together = footprintArea(env, all);
    EXPECT_NEAR(together, sum, 1e-9) << "things overlap";
    const double free_share = 1 - together / env.indoor().area();
    EXPECT_GT(free_share, 0.65);
    EXPECT_LT(free_share, 0.82);
}

INSTANTIATE_TEST_SUITE_P(Files, Scenes,
                         ::testing::Values("ispace.env", "crowded.env", "office.yaml"));

TEST(Scenes, IntelligentSpaceHasTheFactsOfTheThesis) {
    const Environment env = scene("ispace.env");
    EXPECT_EQ(env.inside(), Point2());
    const auto zone = std::find_if(env.elements().begin(), env.elements().end(),
                                   [](const Element& e) { return e.id == "zps"; });
    ASSERT_NE(zone, env.elements().end());
    EXPECT_EQ(bounds(zoneOutline(zone->record)), (Box2{{-4, -4}, {4, 4}}));
    const Slice slice = env.slice(kScanHeight);
    for (const Point2 p : {Point2{0.5, 2}, Point2{0.5, -2}, Point2{}})
        EXPECT_FALSE(slice.blocked(p)) << p.x << ' ' << p.y;
    EXPECT_TRUE(slice.blocked({0.5, 0.3})) << "the front barrier stands in the way";
}

TEST(Scenes, FacilitiesAreOfDifferentKindsAndLeaveTheWallsMostlyFree) {
    const Environment env = scene("facilities.env");
    EXPECT_EQ(env.limits(), (Box2{{-4, -4}, {4, 4}}));
    EXPECT_EQ(env.elements().size(), 11U) << "the room and ten things";
    EXPECT_FALSE(env.slice(kScanHeight).blocked({}));
    constexpr double kOff = 0.05;
    int free = 0, all = 0;
    const Slice slice = env.slice(kScanHeight);
    for (double x = -3.95; x < 4; x += kOff)
        for (const Point2 place : {Point2{x, -4 + kOff}, Point2{x, 4 - kOff}, Point2{-4 + kOff, x},
                                   Point2{4 - kOff, x}}) {
            ++all;
            free += slice.blocked(place) ? 0 : 1;
        }
    EXPECT_GT(free, 0.95 * all);
}

TEST(Scenes, CrowdedRoomIsSquareAndFreeAtTheOrigin) {
    const Environment env = scene("crowded.env");
    EXPECT_EQ(env.limits(), (Box2{{-4.8, -4.8}, {4.8, 4.8}}));
    EXPECT_EQ(env.inside(), Point2());
    EXPECT_NEAR(env.indoor().area(), 92.16, 1e-9);
    EXPECT_FALSE(env.slice(kScanHeight).blocked({}));
}

/// Area of 0.1 m cells of the limits that a laser of 4 m and 180 degrees sees at its best heading
/// of eight, by brute force.
double bestArea(const Environment& env, Point2 from) {
    constexpr double kCell = 0.1;
    const Box2 limits = env.limits();
    const std::vector<Segment2>& walls = env.wallLines();
    int seen[8] = {};
    for (double x = limits.low.x + kCell / 2; x < limits.high.x; x += kCell)
        for (double y = limits.low.y + kCell / 2; y < limits.high.y; y += kCell) {
            const Vec2 v = Point2{x, y} - from;
            if (length(v) > 4) continue;
            const Segment2 sight{from, {x, y}};
            if (std::any_of(walls.begin(), walls.end(),
                            [&](const Segment2& wall) { return intersects(sight, wall); }))
                continue;
            for (int heading = 0; heading < 8; ++heading)
                if (dot(v, unitVector(Angle::degrees(45.0 * heading))) >= 0) ++seen[heading];
        }
    return kCell * kCell * *std::max_element(std::begin(seen), std::end(seen));
}

TEST(Scenes, LRoomIsSeenBestFromOutside) {
    const Environment env = scene("l-room.env");
    EXPECT_EQ(env.limits(), (Box2{{-1, -1}, {7, 7}}));
    EXPECT_DOUBLE_EQ(env.indoor().area(), 28);
    double inside = 0, outside = 0;
    // The places of the thesis' grid: 8 m * 5 / 4 m - 1 lines each way.
    for (int i = 1; i <= 9; ++i)
        for (int j = 1; j <= 9; ++j) {
            const Point2 place{-1 + 0.8 * i, -1 + 0.8 * j};
            double& best = env.indoor().locate(place) == Side::Inside ? inside : outside;
            best = std::max(best, bestArea(env, place));
        }
    EXPECT_GT(inside, 12);
    EXPECT_LT(inside, 16.5);
    EXPECT_GT(outside, 20);
    // The area in the scene's comment.
    EXPECT_NEAR(bestArea(env, {1.01, 4}), 3 * std::sqrt(7.0) + 16 * std::asin(0.75), 0.3);
}

}  // namespace scenes_test
}  // namespace ispace
