// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/coverage_formats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/number.h"
#include "env/walls.h"
#include "support/test_scenes.h"

namespace ispace {
namespace coverage_formats_test {

/// Sees x > 0; a cube stands in the far corner.
const char* const kHalfSeen =
    "ispace size=4,4\ncube at=-1.5,1.5 size=1,1,1\nlaser id=half at=0,0 range=20\n";

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

TEST(CoverageCsv, HasARowForEachCell) {
    const std::string csv = coverageCsv(coverageOf(sceneOf(kHalfSeen), 4, 2));
    EXPECT_EQ(csv,
              "column,row,x,y,indoor,free,seen\n"
              "0,0,-1.5,-1,1,1,0\n1,0,-0.5,-1,1,1,0\n2,0,0.5,-1,1,1,1\n3,0,1.5,-1,1,1,1\n"
              "0,1,-1.5,1,1,0,0\n1,1,-0.5,1,1,1,0\n2,1,0.5,1,1,1,1\n3,1,1.5,1,1,1,1\n");
}

TEST(CoverageGeoJson, HasRegionsViewsAndSpots) {
    const Scene scene = sceneOf(kHalfSeen);
    const std::string json = coverageGeoJson(scene, coverageOf(scene));
    EXPECT_EQ(json.rfind(R"({"type":"FeatureCollection","coordinate_system":"local-metres",)", 0),
              0U);
    for (const char* part :
         {R"("id":"indoor","keyword":"indoor")", R"("id":"free","keyword":"free")",
          R"("id":"seen-1","keyword":"seen","type":"region","sensors":1,"area":8)",
          R"("id":"half","keyword":"laser","type":"placement","heading":0)",
          R"("id":"half","keyword":"view","type":"region")",
          R"("id":"unseen-1","keyword":"unseen","type":"spot","area":7)"})
        EXPECT_EQ(count(json, part), 1U) << part << '\n' << json;
    EXPECT_EQ(count(json, "seen-2"), 0U);
}

/// Of a Polygon or MultiPolygon.
double areaOf(const nlohmann::json& geometry) {
    nlohmann::json pieces = geometry["coordinates"];
    if (geometry["type"] == "Polygon") pieces = nlohmann::json::array({pieces});
    double area = 0;
    for (const auto& piece : pieces)
        for (const auto& coordinates : piece) {
            Polygon ring;
            for (const auto& p : coordinates) ring.push_back({p[0], p[1]});
            ring.pop_back();
            EXPECT_FALSE(selfCrossing(ring));
            area += signedArea(ring);
        }
    return area;
}

/// Areas of the regions of this keyword, by id.
std::map<std::string, double> areasOf(const std::string& json, const std::string& keyword) {
    std::map<std::string, double> areas;
    const nlohmann::json root = nlohmann::json::parse(json);
    for (const auto& feature : root["features"])
        if (feature["properties"]["keyword"] == keyword)
            areas[feature["properties"]["id"]] = areaOf(feature["geometry"]);
    return areas;
}

TEST(CoverageGeoJson, ArcsKeepTheirAreas) {
    const double r = 1.3, apart = 1.7;
    const Scene scene = sceneOf(
        "ispace size=8,6\nlaser id=a at=-0.85,0.3 range=1.3 fov=360 step=1\n"
        "laser id=b at=0.85,0.3 range=1.3 fov=360 step=1\n"
        "laser id=cut at=3.2,-2 heading=20 range=1.5 fov=110 step=0.5\n");
    const Coverage coverage = coverageOf(scene);
    const std::string json = coverageGeoJson(scene, coverage);
    const double disc = std::numbers::pi * r * r;
    const double lens =
        2 * r * r * std::acos(apart / (2 * r)) - apart / 2 * std::sqrt(4 * r * r - apart * apart);
    const double third = signedArea(*coverage.sensors[2].region);
    auto views = areasOf(json, "view"), seen = areasOf(json, "seen");
    EXPECT_NEAR(views["a"] / disc, 1, 1e-9);
    EXPECT_NEAR(views["b"] / disc, 1, 1e-9);
    EXPECT_NEAR(views["cut"] / third, 1, 1e-9);
    EXPECT_NEAR(seen["seen-2"] / lens, 1, 1e-6);
    EXPECT_NEAR(seen["seen-1"] / (2 * (disc - lens) + third), 1, 1e-6);
}

TEST(CoverageGeoJson, OutlinesCellsWhereRegionsAreNotKnown) {
    const Scene scene = sceneOf(
        "ispace size=4,4\n"
        "laser id=nods at=0,0,1 range=20 fov=360 sweep=roll sweep_span=180 sweep_step=1\n");
    const Coverage coverage = coverageOf(scene, 40, 40);
    ASSERT_FALSE(coverage.overlay);
    EXPECT_FALSE(coverage.report.coverage.exact);
    const std::string json = coverageGeoJson(scene, coverage);
    EXPECT_EQ(count(json, R"("id":"seen-1")"), 1U);
    EXPECT_EQ(count(json, R"("keyword":"view")"), 1U);
}

/// From above: 500 pixels across are 4 m of floor, 125 pixels a metre.
const char* const kFromAbove =
    "ispace size=6,4\ncamera id=above at=0,0,4 tilt=-90 fx=500 pixels=500,500\n";

TEST(CoverageCsv, NamesTheClassOfEachCell) {
    const Scene scene = sceneOf(kFromAbove);
    const std::string csv = coverageCsv(coverageOf(scene, 3, 1));
    EXPECT_EQ(csv,
              "column,row,x,y,indoor,free,seen,density\n"
              "0,0,-2,0,1,1,1,recognise\n1,0,0,0,1,1,1,recognise\n2,0,2,0,1,1,1,recognise\n");
    const std::string none = coverageCsv(coverageOf(scene, 6, 1));
    EXPECT_EQ(none.substr(none.find('\n') + 1, 18), "0,0,-2.5,0,1,1,0,\n");
}

TEST(CoverageGeoJson, HasTheFloorOfEachClass) {
    const Scene scene = sceneOf(kFromAbove);
    const std::string json = coverageGeoJson(scene, coverageOf(scene, 60, 40));
    for (
        const char* part :
        {R"("id":"density-detect","keyword":"density","type":"region","pixels_per_metre":25,"area":16)",
         R"("id":"density-recognise","keyword":"density","type":"region","pixels_per_metre":125,"area":16)"})
        EXPECT_EQ(count(json, part), 1U) << part << '\n' << json;
    EXPECT_EQ(count(json, "density-identify"), 0U);
}

TEST(CoverageRosMap, TellsSeenUnseenAndOccupiedApart) {
    const Scene scene = sceneOf(kHalfSeen);
    RayScenes worlds(scene.environment);
    const Coverage coverage = measureCoverage(scene, worlds, {.cells = CellSize{0.05}});
    const CoverageFiles map = coverageRosMap(coverage, 0.05, "plan.pgm");
    EXPECT_EQ(map.product,
              "image: plan.pgm\nmode: trinary\nresolution: 0.05\norigin: [-2, -2, 0]\n"
              "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    const std::string header = "P5\n80 80\n255\n";
    ASSERT_EQ(map.beside.substr(0, header.size()), header);
    const std::string pixels = map.beside.substr(header.size());
    ASSERT_EQ(pixels.size(), 6400U);
    EXPECT_EQ(std::count(pixels.begin(), pixels.end(), static_cast<char>(254)), 3200);
    EXPECT_EQ(std::count(pixels.begin(), pixels.end(), static_cast<char>(0)), 400);
    EXPECT_EQ(pixels[0], 0) << "the first line is the uppermost, where the cube stands";
    EXPECT_EQ(pixels[79], static_cast<char>(254));
    EXPECT_EQ(pixels[79 * 80], static_cast<char>(205));
}

TEST(MakeTarget, SquareCellsMayReachBeyondTheLimits) {
    const Scene scene = sceneOf("ispace size=4,3");
    const Target target = makeTarget(scene.environment, CellSize{0.7}, kScanHeight);
    EXPECT_EQ(target.grid.columns, 6);
    EXPECT_EQ(target.grid.rows, 5);
    EXPECT_NEAR(target.grid.cellArea(), 0.49, 1e-12);
    EXPECT_EQ(target.grid.limits.low, (Point2{-2, -1.5}));
    EXPECT_EQ(makeTarget(scene.environment, CellSize{0.1}, kScanHeight).grid.columns, 40);
    EXPECT_EQ(makeTarget(scene.environment, CellSize{100}, kScanHeight).grid.size(), 1U);
}

/// The grid that follows a room of this size.
Grid roomGrid(double width, double depth, int most = RoomCells().most) {
    return gridOver({{-1, 2}, {-1 + width, 2 + depth}}, RoomCells{most});
}

double edgeOf(const Grid& grid) { return grid.limits.width() / grid.columns; }

TEST(RoomCells, AreSquaresOfATenthOfAMetre) {
    const Grid grid = roomGrid(30, 15);
    EXPECT_EQ(grid.columns, 300);
    EXPECT_EQ(grid.rows, 150);
    EXPECT_EQ(cellsText(grid), "300 x 150 cells of 0.1 m");
    EXPECT_EQ(roomGrid(10, 10).size(), 10'000U);
}

TEST(RoomCells, AreSmallerInSmallRoomsAndLargerInHugeBuildings) {
    EXPECT_EQ(cellsText(roomGrid(8, 6)), "116 x 87 cells of 0.069 m");
    EXPECT_EQ(cellsText(roomGrid(54, 56.95)), "416 x 439 cells of 0.13 m");
    EXPECT_EQ(cellsText(roomGrid(54, 56.95, 40'000)), "193 x 204 cells of 0.28 m");
    EXPECT_EQ(cellsText(roomGrid(30'000, 4'000)), "1200 x 160 cells of 25 m");
    for (const double size : {1e-3, 0.02, 0.3, 1.0, 7.7, 44.7, 45.0, 300.0, 1e4, 1e6})
        for (const double slender : {1.0, 3.7, 100.0, 1e4}) {
            const Grid grid = roomGrid(size, size / slender);
            EXPECT_NEAR(edgeOf(grid), grid.limits.depth() / grid.rows, 1e-9 * size);
            EXPECT_LE(grid.size(), 200'000U) << size << " / " << slender;
            EXPECT_TRUE(edgeOf(grid) <= 0.1 + 1e-9 || grid.size() > 150'000U)
                << size << " / " << slender << ": " << cellsText(grid);
            EXPECT_TRUE(grid.size() >= 10'000U || edgeOf(grid) <= 1.001e-4)
                << size << " / " << slender << ": " << cellsText(grid);
        }
}

}  // namespace coverage_formats_test
}  // namespace ispace
