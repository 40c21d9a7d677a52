// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/installation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "drawing/plan/plan.h"
#include "extensions/pages/coverage_page.h"
#include "extensions/pages/indoor_floor.h"
#include "extensions/pages/page_writer.h"
#include "report/map/depth_shades.h"
#include "report/map/sensor_colors.h"
#include "support/test_scenes.h"

namespace ispace::pages {
namespace installation_test {

Coverage coverageFor(const Scene& scene) {
    RayScenes worlds(scene.environment);
    return measureCoverage(scene, worlds, {});
}

TEST(Installation, MeasuresToTheWallsThatTheSensorFaces) {
    // Walls 0.2 m thick; the inner one hides the right wall of the upper half.
    const Scene scene = sceneOf(
        "#env 1\n"
        "wall id=south from=0,0 to=6,0 height=2.5 thickness=0.2\n"
        "wall id=east from=6,0 to=6,4 height=2.5 thickness=0.2\n"
        "wall id=north from=6,4 to=0,4 height=2.5 thickness=0.2\n"
        "wall id=west from=0,4 to=0,0 height=2.5 thickness=0.2\n"
        "wall id=inner from=3,2 to=3,4 height=2.5 thickness=0.2\n"
        "laser id=l1 at=2,3,1\n"
        "laser id=l2 at=5.9,1,2.6 heading=180\n"
        "robot id=r at=1,1\nlaser id=rider on=r\n");
    const std::vector<Installation> all = installationsOf(scene);
    ASSERT_EQ(all.size(), 2U);
    ASSERT_EQ(all[0].walls.size(), 2U);
    EXPECT_NEAR(all[0].walls[0].distance, 0.9, 1e-12);
    EXPECT_NEAR(all[0].walls[1].distance, 0.9, 1e-12);
    EXPECT_NE(all[0].walls[0].wall, all[0].walls[1].wall);
    for (const WallDistance& wall : all[0].walls)
        EXPECT_TRUE(wall.wall == "north" || wall.wall == "inner") << wall.wall;
    // Above the walls, and on one.
    ASSERT_EQ(all[1].walls.size(), 2U);
    EXPECT_EQ(all[1].walls[0].wall, "east");
    EXPECT_NEAR(all[1].walls[0].distance, 0, 1e-12);
    EXPECT_EQ(all[1].walls[1].wall, "south");
    EXPECT_NEAR(all[1].walls[1].distance, 0.9, 1e-12);
}

TEST(Installation, FacesEndWhereAPersonSeesTheirCorners) {
    // Walls and a fence whose bodies overlap at the corners; the room is an L.
    const Scene scene = sceneOf(
        "#env 1\n"
        "fence id=f path=0,0;8,0;8,3;4,3;4,6;0,6 closed=yes height=2.5 thickness=0.4\n"
        "wall id=w from=6,0 to=6,1.5 height=2.5 thickness=0.3\n"
        "laser id=low at=5,0.5,1 heading=90\n"       // between the west and the thin wall
        "laser id=under at=6.9,2.6,1 heading=-90\n"  // under the step, which ends at a convex
                                                     // corner
        "laser id=on at=0.2,5.7,1 heading=0\n");     // on a face, near a corner
    const std::vector<Installation> all = installationsOf(scene);
    ASSERT_EQ(all.size(), 3U);
    const auto expectFace = [](const WallDistance& wall, Segment2 face) {
        const bool turned = distance(wall.face.a, face.a) > distance(wall.face.a, face.b);
        EXPECT_NEAR(distance(wall.face.a, turned ? face.b : face.a), 0, 1e-9) << wall.wall;
        EXPECT_NEAR(distance(wall.face.b, turned ? face.a : face.b), 0, 1e-9) << wall.wall;
    };
    expectFace(all[0].walls[0], {{0.2, 0.2}, {5.85, 0.2}});
    expectFace(all[0].walls[1], {{5.85, 0.2}, {5.85, 1.5}});
    expectFace(all[1].walls[0], {{3.8, 2.8}, {7.8, 2.8}});
    expectFace(all[1].walls[1], {{7.8, 0.2}, {7.8, 2.8}});
    expectFace(all[2].walls[0], {{0.2, 0.2}, {0.2, 5.8}});
    expectFace(all[2].walls[1], {{0.2, 5.8}, {3.8, 5.8}});
}

/// A line on which the sensor lies: normal * p = offset.
struct PlaceLine {
    Vec2 normal;
    double offset = 0;
};

double dotOf(Vec2 a, Point2 b) { return a.x * b.x + a.y * b.y; }

Vec2 directionIn(const std::string& text) {
    const std::string word = text.substr(text.rfind(", ") + 2);
    if (word == "+x") return {1, 0};
    if (word == "-x") return {-1, 0};
    if (word == "+y") return {0, 1};
    if (word == "-y") return {0, -1};
    const double angle = std::stod(word) * std::numbers::pi / 180;
    return {std::cos(angle), std::sin(angle)};
}

/// Reads a measure of the sheet as a person does.
PlaceLine lineIn(const std::string& cell, const std::map<std::string, Segment2>& faces) {
    const auto face = [&](const std::string& name) {
        EXPECT_TRUE(faces.contains(name)) << cell;
        const Segment2& one = faces.at(name);
        return std::pair(one, (1 / distance(one.a, one.b)) * (one.b - one.a));
    };
    if (cell.starts_with("on ")) {
        const auto [line, along] = face(cell.substr(3));
        const Vec2 normal = perpendicular(along);
        return {normal, dotOf(normal, line.a)};
    }
    const double length = std::stod(cell);
    const Vec2 to = directionIn(cell);
    if (const auto at = cell.find(" along "); at != std::string::npos) {
        const auto from = cell.find(" from (");
        const auto [line, way] = face(cell.substr(at + 7, from - at - 7));
        const Vec2 along = dot(way, to) > 0 ? way : -1 * way;
        const auto comma = cell.find(", ", from);
        const Point2 end{std::stod(cell.substr(from + 7)), std::stod(cell.substr(comma + 2))};
        return {along, dotOf(along, end) + length};
    }
    const auto at = cell.find(" to ");
    const auto [line, way] = face(cell.substr(at + 4, cell.rfind(", ") - at - 4));
    const Vec2 across = perpendicular(way), normal = dot(across, to) > 0 ? across : -1 * across;
    return {normal, dotOf(normal, line.a) - length};
}

/// Finds the sensors of a layout again from the texts of its sheet alone.
void findAgain(const std::string& room, const std::string& layout, std::size_t count) {
    const Scene scene = sceneOf(room + layout);
    const std::vector<Installation> all = installationsOf(scene);
    ASSERT_EQ(all.size(), count);
    const PageTable sheet = installationTable(scene, coverageFor(scene), all, {});
    std::map<std::string, Segment2> faces;
    for (const TextRow& row : wallFacesTable(all).rows)
        faces[row[0]] = {{std::stod(row[1]), std::stod(row[2])},
                         {std::stod(row[3]), std::stod(row[4])}};
    for (std::size_t i = 0; i < count; ++i) {
        const TextRow& row = sheet.rows[i];
        const PlaceLine a = lineIn(row[8], faces), b = lineIn(row[9], faces);
        const double area = cross(a.normal, b.normal);
        ASSERT_GT(std::abs(area), 0.4) << row[8] << "; " << row[9];
        const Point2 found{(a.offset * b.normal.y - b.offset * a.normal.y) / area,
                           (a.normal.x * b.offset - b.normal.x * a.offset) / area};
        const Point2 planned = scene.sensors[i].pose.position.onFloor();
        EXPECT_LT(distance(found, planned), 0.004) << row[0] << " at " << planned.x << ' '
                                                   << planned.y << ": " << row[8] << "; " << row[9];
    }
}

constexpr const char* kOctagon =
    "#env 1\nfence id=f path=2,0;6,0;8,2;8,5;6,7;2,7;0,5;0,2 closed=yes height=3\n";

TEST(Installation, TwoCamerasOfASheetAreFoundAgain) {
    findAgain(
        "#env 1\nispace id=hall size=8,6,2.5\nwall id=inner from=-4,1 to=-1,1 height=2.5 "
        "thickness=0.2\n",
        "camera id=door at=-3.9,-2.9,2.4 heading=40 tilt=-20\n"
        "camera id=till at=1.37,2.9,2.4 heading=-90 tilt=-30\n",
        2);
}

TEST(Installation, SensorsNearWallsAt45DegreesAreFoundAgain) {
    // On a diagonal wall, off it, in corners that it makes, and in the middle.
    findAgain(kOctagon,
              "camera id=on at=6.9,1 heading=135\n"  // off by 0.07
              "camera id=rounded at=7.3,1.3 heading=135\n"
              "laser id=corner at=2.05,0.05,1\nlaser id=other at=7.95,4.98,1\n"
              "laser id=near at=0.6,6,1\nlaser id=middle at=4,3.5,1\n",
              6);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> along(0.01, 0.99);
    std::string layout;
    for (int i = 0; i < 40; ++i) {
        // On the diagonal from (6, 0) to (8, 2), as doubles have it.
        const double share = along(random);
        layout += "laser at=" + std::to_string(6 + 2 * share) + ',' + std::to_string(2 * share) +
                  ",1 heading=135\n";
    }
    findAgain(kOctagon, layout, 40);
}

TEST(Installation, MeasuresAlongAWallWithoutAnotherOne) {
    // A triangle with sharp angles: most of its walls are nearly parallel.
    const std::string sliver = "#env 1\nfence id=f path=0,0;20,0;20,1.5 closed=yes height=3\n";
    findAgain(sliver, "laser id=l at=10,0.3,1\nlaser id=m at=19,0.7,1\n", 2);
}

TEST(Installation, MeasuresFromACornerWhereTheNextWallIsFar) {
    const std::string corridor =
        "#env 1\nfence id=f path=0,0;40,0;40,2;0,2 closed=yes height=3\n"
        "wall id=stub from=17,0 to=17,0.5 height=3\n";
    const std::string layout = "laser id=l at=20,1.1,1\nlaser id=m at=36,1.9,1\n";
    const std::vector<Installation> all = installationsOf(sceneOf(corridor + layout));
    ASSERT_EQ(all.size(), 2U);
    ASSERT_TRUE(all[0].walls[1].end);
    EXPECT_EQ(*all[0].walls[1].end, (Point2{17, 0.5}));
    EXPECT_NEAR(all[0].walls[1].distance, 3, 1e-12);
    EXPECT_FALSE(all[1].walls[1].end);
    EXPECT_NEAR(all[1].walls[1].distance, 4, 1e-12);
    findAgain(corridor, layout, 2);
    // The steps of a map are no corners.
    const std::string stepped =
        "#env 1\nfence id=f path=0,0;17,0;17,0.1;18,0.1;18,0;40,0;40,2;0,2 closed=yes height=3\n";
    const std::vector<Installation> steps = installationsOf(sceneOf(stepped + layout));
    EXPECT_FALSE(steps[0].walls[1].end && steps[0].walls[1].end->x < 30);
}

TEST(Installation, TurnedRoomsAreFoundAgain) {
    for (const int degrees : {7, 30, 45, 61}) {
        const Angle turn = Angle::degrees(degrees);
        const Vec2 u{cos(turn), sin(turn)}, v = perpendicular(u);
        const auto text = [&](double x, double y) {
            const Point2 p = Point2{} + x * u + y * v;
            return std::to_string(p.x) + ',' + std::to_string(p.y);
        };
        const std::string room = "#env 1\nfence id=f path=" + text(0, 0) + ';' + text(7, 0) + ';' +
                                 text(7, 4) + ';' + text(0, 4) + " closed=yes height=3\n";
        findAgain(room,
                  "laser id=a at=" + text(0.5, 1.2) + ",1\nlaser id=b at=" + text(7, 3) +
                      ",1 heading=" + std::to_string(degrees + 180) + "\n",
                  2);
    }
}

TEST(LensDensity, IsThatOfTheLens) {
    const auto density_of = [](const std::string& keys, Point3 place) {
        const Scene scene = sceneOf("#env 1\nispace size=30,30,6\ncamera at=0,0,2 " + keys + '\n');
        return lensDensity(scene.sensors[0], place);
    };
    // Of a pinhole the focal length over the depth, anywhere in the picture.
    const std::string pinhole = "fx=800 pixels=1600,1200";
    EXPECT_NEAR(density_of(pinhole, {4, 0, 2}), 200, 1e-6);
    EXPECT_NEAR(density_of(pinhole, {4, 3, 1}), 200, 1e-6);
    EXPECT_EQ(density_of(pinhole, {-4, 0, 2}), 0);
    // With k1 < 0 lines about the centre shrink by 1 + k1 r^2, at r = 3/4, those towards the edge
    // by 1 + 3 k1 r^2. A target that faces the camera is seen 1 / cos steeper along the latter.
    const double r = 0.75, cosine = 0.8;
    EXPECT_NEAR(density_of(pinhole + " coefficients=-0.1,0,0,0", {4, 3, 2}),
                200 * (1 - 0.1 * r * r), 1e-9);
    EXPECT_NEAR(density_of(pinhole + " coefficients=-0.2,0,0,0", {4, 3, 2}),
                200 * (1 - 3 * 0.2 * r * r) / cosine, 1e-9);
    // Of an equidistant fisheye pixels a radian over the distance, in the middle and at the edge.
    const std::string fisheye = "projection=fisheye fov=180 pixels=1000,1000 tilt=-90";
    const double radian = 500 / (std::numbers::pi / 2);
    EXPECT_NEAR(density_of(fisheye, {0, 0, 0}), radian / 2, 0.01);
    EXPECT_NEAR(density_of(fisheye, {8, 0, 0.5}), radian / std::hypot(8, 1.5), 0.01);
}

TEST(SensorPictures, AreDrawnOfFlatAndTinyPictures) {
    for (const char* keys :
         {"at=0.2,0.2,1.6 heading=45 pixels=640,28", "at=0.2,0.2,1.6 heading=45 pixels=32,4",
          "at=0.2,0.2,2.3 heading=45 tilt=-30 pixels=1,1"}) {
        const Scene scene =
            sceneOf(std::string("#env 1\nispace id=hall at=4,3 size=8,6,2.5\nzone id=z at=2,2 "
                                "size=1,1\ncamera id=c ") +
                    keys + '\n');
        RayScenes worlds(scene.environment);
        CoverageOptions options;
        options.plane = 1.6;
        const auto figures = sensorPictures(scene, measureCoverage(scene, worlds, options));
        ASSERT_EQ(figures.size(), 1U) << keys;
        EXPECT_NE(figures[0].caption.find("in z, "), std::string::npos) << figures[0].caption;
    }
}

TEST(CoveragePage, TellsAtWhichDensityAndHeightFloorIsJudged) {
    CoverageReport report;
    EXPECT_EQ(judgedAtText(report), "");
    EXPECT_EQ(facesJudgedAtText(report), ", judged on the floor");
    report.density = 250;
    report.plane = 1.6;
    const std::string all =
        " with 250 pixels a metre or more (identify / characterise), 1.60 m above the floor";
    EXPECT_EQ(judgedAtText(report), all);
    EXPECT_EQ(facesJudgedAtText(report), all);
    report.density = 77;
    report.plane = 0;
    EXPECT_EQ(judgedAtText(report), " with 77 pixels a metre or more");
}

TEST(CameraSheets, FitOnOneSheetOfEitherPaper) {
    const Scene scene = sceneOf(
        "#env 1\nispace id=hall at=4,3 size=8,8,2.5\n"
        "camera id=camera1 at=0.2,0.2,2.4 heading=45 tilt=-30 pixels=1920,1080\n"
        "camera id=c2 at=7.8,0.2,2.4 heading=135 tilt=-30 pixels=640,480\n"
        "camera id=c3 at=4,3,2.4 projection=fisheye fov=180 tilt=-90 pixels=480,480\n");
    RayScenes worlds(scene.environment);
    const Coverage coverage = measureCoverage(scene, worlds, {});
    std::vector<PageFigure> figures = sensorPictures(scene, coverage);
    const PageTable table = installationTable(scene, coverage, installationsOf(scene), {});
    ReportPage page{"Hall", "", cameraSheets(scene, coverage, table, figures)};
    ASSERT_EQ(page.sections.size(), 3U);
    EXPECT_EQ(page.sections[0].title, "camera1");
    EXPECT_EQ(page.sections[1].title, "Camera c2");
    for (const Paper paper : {Paper::A4, Paper::Letter}) {
        page.paper = paper;
        const std::vector<Picture> sheets = sheetsOf(page);
        ASSERT_EQ(sheets.size(), 4U);  // the title's, and one each
        for (std::size_t i = 1; i < sheets.size(); ++i) {
            std::size_t captions = 0;
            for (const DisplayList::Text& text : sheets[i].list().texts)
                captions += text.text.find("the floor that it sees") != std::string::npos ? 1 : 0;
            EXPECT_EQ(captions, 1U) << i;
        }
    }
}

TEST(CameraSheets, HaveTheFloorOfCamerasInBuildings) {
    const Scene scene = sceneOf(
        "#env 1\nispace id=hall at=4,3 size=8,8,2.5\n"
        "laser id=l at=1,1\ncamera id=c at=0.2,0.2,2.4 heading=45 tilt=-30 pixels=640,480\n");
    RayScenes worlds(scene.environment);
    Coverage coverage = measureCoverage(scene, worlds, {});
    // Ids name the storey there, but those of the scene do not.
    for (SensorView& view : coverage.sensors) view.id.insert(0, "ground/");
    std::vector<PageFigure> figures = sensorPictures(scene, coverage);
    const PageTable table = installationTable(scene, coverage, installationsOf(scene), {});
    const std::vector<PageSection> sheets = cameraSheets(scene, coverage, table, figures);
    ASSERT_EQ(sheets.size(), 1U);
    ASSERT_EQ(sheets[0].blocks.size(), 3U) << "table, picture, floor";
    EXPECT_EQ(std::get<PageFigure>(sheets[0].blocks[2]).caption,
              "ground/c: the floor that it sees");
}

TEST(IndoorFloor, EndsAtOpenDoors) {
    // Half of the disc of `door` is outside, behind an open door.
    const Scene scene = sceneOf(
        "#env 1\nwall id=s from=0,0 to=8,0 height=3\nwall id=e from=8,0 to=8,6 height=3\n"
        "wall id=n from=8,6 to=0,6 height=3\nwall id=w from=0,6 to=0,0 height=3\n"
        "door id=d wall=s offset=4 size=7,2.5 open=yes\n"
        "laser id=door at=4,0.000001,1 heading=90 fov=360 step=1 range=2\n"
        "laser id=in at=4,3,1 fov=360 step=1 range=2\n");
    const Coverage coverage = coverageFor(scene);
    const std::vector<IndoorFloor> floors = indoorFloors(scene, coverage);
    ASSERT_EQ(floors.size(), 2U);
    const double pi = std::numbers::pi;
    EXPECT_NEAR(*coverage.report.sensors[0].area.exact, 2 * pi, 0.05)
        << "the half beyond the limits has a figure of its own";
    EXPECT_NEAR(floors[0].seen, 2 * pi, 0.01) << "half of it is indoors";
    EXPECT_NEAR(floors[1].seen, 4 * pi, 0.01);
    // Two discs of radius 2, 3 apart, share a lens.
    const double lens = 2 * 4 * std::acos(0.75) - 1.5 * std::sqrt(16.0 - 9);
    EXPECT_NEAR(floors[0].seen - floors[0].alone, lens, 0.01);
    EXPECT_NEAR(floors[1].seen - floors[1].alone, lens, 0.01);
}

TEST(IndoorFloor, IsTheSameWithShadesOfFewerDepths) {
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
    Coverage shaded = measureCoverage(scene, worlds, {.keep_depths = false});
    addDepthShades(shaded, scene);
    const auto floors = indoorFloors(scene, shaded);
    const auto wanted = indoorFloors(scene, coverageFor(scene));
    ASSERT_EQ(floors.size(), wanted.size());
    for (std::size_t i = 0; i < floors.size(); ++i)
        EXPECT_NEAR(floors[i].alone, wanted[i].alone, 1e-6) << i;
}

TEST(SensorColors, NeighboursDifferBeyondSeven) {
    std::string lines = "#env 1\nispace size=40,4,3\n";
    for (int i = 0; i < 30; ++i)
        lines += "laser at=" + std::to_string(-19 + 1.25 * (i * 7 % 30)) + ",0,1 range=2\n";
    const Coverage coverage = coverageFor(sceneOf(lines));
    const std::vector<std::size_t> hues = sensorHues(coverage);
    ASSERT_EQ(hues.size(), 30U);
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(hues[i], i);
    for (std::size_t i = 0; i < 30; ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (distance(coverage.sensors[i].pose.position.onFloor(),
                         coverage.sensors[k].pose.position.onFloor()) < 1.5) {
                EXPECT_NE(hues[i], hues[k]) << i << ' ' << k;
            }
}

/// Distances of the plan, by the horizontal and upright lines that their texts cover.
TEST(InstallationPlan, DistancesAreWrittenInTheirOwnLines) {
    // The upright line of b passes the middle of the horizontal one of a.
    const Scene scene = sceneOf(
        "ispace size=10,8\nlaser id=a at=1,-2,1 heading=90\nlaser id=b at=3,-1,1 heading=90\n");
    const Picture plan =
        installationPlan(scene, coverageFor(scene), installationsOf(scene)).picture;
    const DisplayList& list = plan.list();
    std::vector<Segment2> lines;
    for (const DisplayList::Shape& shape : list.shapes)
        for (std::uint32_t i = shape.first;
             shape.kind == DisplayList::Kind::Lines && i < shape.last; ++i)
            if (const auto curve = list.curve(i); curve.size() == 2)
                lines.push_back({curve.front(), curve.back()});
    constexpr double kPerMetre = 10;  // millimetres at 1:100
    int found = 0;
    for (const DisplayList::Text& text : list.texts) {
        const double wide = textWidth(text.text, text.style) / 2;
        const Point2 middle = text.anchor - Vec2{0, 0.36 * text.style.size};
        const Box2 box{middle - Vec2{wide, text.style.size / 2},
                       middle + Vec2{wide, text.style.size / 2}};
        if (text.text.size() != 4 || text.text[1] != '.') continue;
        ++found;
        for (const Segment2& line : lines) {
            if (!crosses(line, box)) continue;
            EXPECT_NEAR(distance(line.a, line.b), kPerMetre * std::stod(text.text), 0.2)
                << text.text;
        }
    }
    EXPECT_EQ(found, 4);
}

/// Returns the ids of a page's sections, and the texts of its summary.
std::vector<std::string> outlineOf(const std::string& lines) {
    const Scene scene = sceneOf(lines);
    const Coverage coverage = coverageFor(scene);
    std::vector<std::string> outline;
    const ReportPage page = coveragePage({scene, coverage, "a.env", "coverage a.env"});
    for (const PageSection& section : page.sections) outline.push_back(section.id);
    for (const PageBlock& block : page.sections.front().blocks)
        outline.push_back(std::get<PageText>(block).text);
    return outline;
}

TEST(CoveragePage, LeavesOutTheSheetWithoutSensors) {
    EXPECT_EQ(outlineOf("ispace size=4,4\nrobot id=r at=1,1\n"),
              (std::vector<std::string>{
                  "summary", "map", "methods", "records",
                  "The room has 16.00 m² of indoor floor, 16.00 m² of it free at 0.15 m, and no "
                  "sensors."}));
    // One that rides on a robot is in no plan, and alone sees no floor twice.
    EXPECT_EQ(outlineOf("ispace size=4,4\nrobot id=r at=1,1\nlaser on=r range=9 fov=360\n"),
              (std::vector<std::string>{
                  "summary", "map", "sensors", "material", "methods", "records",
                  "The room has 16.00 m² of indoor floor, 16.00 m² of it free at 0.15 m, and 1 "
                  "sensor: 1 × laser.",
                  "The sensors see 100.00% of the indoor floor."}));
}

}  // namespace installation_test
}  // namespace ispace::pages
