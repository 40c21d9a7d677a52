// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exporters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "drawing/plan/elements.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "support/test_layout.h"

namespace ispace {
namespace geojson_test {

using Json = nlohmann::json;
using ispace::testing::scene;

const char* const kRoom =
    "fence id=outer path=0,0;8,0;8,6;3,6;3,5;0,5 closed=yes height=2.6\n"
    "wall id=thick from=5,0 to=5,2 thickness=0.1 kind=brick\n"
    "wall id=thin from=3,5 to=3,3.6\n"
    "inside id=known at=1,1\n"
    "fence id=shaft path=6,4;7,4;7,5;6,5 closed=yes\n"
    "zone id=z path=1,1;1,2;2,2;2,1\n"
    "floor id=carpet at=2,3 size=2,1 kind=checker friction=0.2\n"
    "desk id=d1 at=1.5,4 heading=30\ntable id=t1 at=5,3\n";

Json featuresOf(const Scene& from, std::optional<double> height = {}) {
    const Json root = Json::parse(writeGeoJson(from, height));
    EXPECT_EQ(root["type"], "FeatureCollection");
    EXPECT_EQ(root["coordinate_system"], "local-metres");
    return root["features"];
}

Json featureOf(const Json& features, const std::string& id) {
    for (const Json& feature : features)
        if (feature["properties"]["id"] == id) return feature;
    return nullptr;
}

Polygon ringOf(const Json& coordinates) {
    Polygon ring;
    for (const Json& p : coordinates) ring.push_back({p[0], p[1]});
    EXPECT_EQ(ring.front(), ring.back());
    EXPECT_GE(ring.size(), 4U);
    ring.pop_back();
    return ring;
}

/// Checks what RFC 7946 wants of Polygons; the area of all pieces.
double areaOf(const Json& geometry) {
    Json pieces = geometry["coordinates"];
    if (geometry["type"] == "Polygon") pieces = Json::array({pieces});
    double area = 0;
    for (const Json& piece : pieces) {
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const double of_ring = signedArea(ringOf(piece[i]));
            EXPECT_EQ(of_ring > 0, i == 0) << "outlines counter-clockwise, holes clockwise";
            area += of_ring;
        }
    }
    return area;
}

TEST(GeoJson, RoomAndFreeFloor) {
    const Scene room = scene(kRoom);
    const Json features = featuresOf(room);
    const Json indoor = featureOf(features, "indoor");
    EXPECT_EQ(indoor["geometry"]["type"], "Polygon");
    EXPECT_EQ(indoor["geometry"]["coordinates"].size(), 2U);
    EXPECT_DOUBLE_EQ(areaOf(indoor["geometry"]), room.environment.indoor().area());
    EXPECT_DOUBLE_EQ(indoor["properties"]["area"], room.environment.indoor().area());
    double free = 0;
    for (const Json& feature : features)
        if (feature["properties"]["keyword"] == "free") free += areaOf(feature["geometry"]);
    EXPECT_NEAR(free, totalArea(room.environment.level(kScanHeight)->freeFloor()), 1e-9);
}

TEST(GeoJson, ElementsInOrder) {
    const Json features = featuresOf(scene(kRoom));
    std::vector<std::string> ids;
    for (const Json& feature : features)
        if (feature["properties"]["type"] != "region") ids.push_back(feature["properties"]["id"]);
    EXPECT_EQ(ids, (std::vector<std::string>{"outer", "thick", "thin", "known", "shaft", "z",
                                             "carpet", "d1", "t1"}));
}

TEST(GeoJson, WallsAreLines) {
    const Json features = featuresOf(scene(kRoom));
    const Json outer = featureOf(features, "outer");
    EXPECT_EQ(outer["geometry"]["type"], "LineString");
    EXPECT_EQ(outer["geometry"]["coordinates"].size(), 7U);
    EXPECT_EQ(outer["properties"]["height"], 2.6);
    EXPECT_EQ(outer["properties"]["thickness"], 0.0);
    EXPECT_EQ(outer["properties"]["closed"], true);
    const Json thick = featureOf(features, "thick");
    EXPECT_EQ(thick["geometry"]["coordinates"], Json::parse("[[5.0,0.0],[5.0,2.0]]"));
    EXPECT_EQ(thick["properties"]["thickness"], 0.1);
    EXPECT_EQ(thick["properties"]["kind"], "brick");
    EXPECT_EQ(thick["properties"]["type"], "wall");
}

TEST(GeoJson, ThingsAreWhatTheyCover) {
    const Json features = featuresOf(scene(kRoom));
    const Json desk = featureOf(features, "d1");
    EXPECT_NEAR(areaOf(desk["geometry"]), 1.2 * 0.8, 1e-9);
    EXPECT_EQ(desk["properties"]["bottom"], 0.0);
    EXPECT_EQ(desk["properties"]["top"], 0.7);
    EXPECT_EQ(desk["properties"]["heading"], 30.0);
    EXPECT_EQ(desk["properties"]["kind"], "legs");
    EXPECT_NEAR(areaOf(featureOf(features, "t1")["geometry"]), 0.45 * 0.45 * std::numbers::pi,
                1e-9);
    EXPECT_NEAR(areaOf(featureOf(features, "z")["geometry"]), 1, 1e-12);
    EXPECT_NEAR(areaOf(featureOf(features, "carpet")["geometry"]), 2, 1e-12);
    EXPECT_EQ(featureOf(features, "carpet")["properties"]["friction"], 0.2);
    EXPECT_EQ(featureOf(features, "known")["geometry"],
              Json::parse(R"({"type":"Point","coordinates":[1.0,1.0]})"));
}

TEST(GeoJson, PlacedThings) {
    Scene room = scene(std::string(kRoom) +
                       "laser id=l1 at=1,2,0.5 heading=200 model=urg-04lx\n"
                       "mat id=m1 at=2,2 size=1,0.5\ngate id=g1 at=4,4 width=2 heading=90\n"
                       "human id=h1 at=4,1\nrobot id=r1 at=7,1 heading=-90\n");
    ASSERT_EQ(room.placed.size(), 5U);
    const Json features = featuresOf(room);
    const Json laser = featureOf(features, "l1");
    EXPECT_EQ(laser["geometry"]["coordinates"], Json::parse("[1.0,2.0]"));
    EXPECT_EQ(laser["properties"]["z"], 0.5);
    EXPECT_EQ(laser["properties"]["heading"], -160.0);
    EXPECT_EQ(laser["properties"]["model"], "urg-04lx");
    EXPECT_NEAR(areaOf(featureOf(features, "m1")["geometry"]), 0.5, 1e-12);
    EXPECT_EQ(featureOf(features, "g1")["geometry"],
              Json::parse(R"({"type":"LineString","coordinates":[[3.0,4.0],[5.0,4.0]]})"));
    EXPECT_EQ(featureOf(features, "r1")["geometry"]["type"], "Point");
    EXPECT_EQ(featureOf(features, "h1")["properties"]["keyword"], "human");
}

TEST(GeoJson, SliceAlone) {
    const Scene room = scene(kRoom);
    const double height = 0.3;
    const Json root = Json::parse(writeGeoJson(room, height));
    EXPECT_EQ(root["height"], height);
    const Json features = root["features"];
    const Slice slice = room.environment.slice(height);
    std::size_t lines = 0, solids = 0;
    std::set<std::string> owners;
    for (const Json& feature : features) {
        if (feature["properties"]["keyword"] == "free") continue;
        (feature["geometry"]["type"] == "LineString" ? lines : solids) += 1;
        if (feature["geometry"]["type"] == "Polygon") {
            EXPECT_GT(areaOf(feature["geometry"]), 0);
        }
        owners.insert(feature["properties"]["id"]);
        EXPECT_EQ(feature["properties"]["z"], height);
    }
    EXPECT_EQ(lines, slice.sheets.size());
    EXPECT_EQ(solids, slice.solids.size());
    EXPECT_EQ(owners, (std::set<std::string>{"outer", "thick", "thin", "shaft", "d1", "t1"}));
    EXPECT_TRUE(featuresOf(room, 50.0).size() == 1U);
}

}  // namespace geojson_test
}  // namespace ispace
