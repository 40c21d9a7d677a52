// SPDX-License-Identifier: GPL-3.0-or-later
// Plans in surveyors' coordinates, with strays far away, and meshes as other programs spell them.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "base/file.h"
#include "base/number.h"
#include "io/importers.h"
#include "io/mesh/mesh_file.h"
#include "support/test_folder.h"
#include "support/test_import.h"

namespace ispace {
namespace {

/// Expects that the plan's corner lies less than a metre from the origin, and one note about it.
void expectMoved(const Document& document, const ImportReport& report, double area) {
    const Environment room = environmentOf(document);
    EXPECT_NEAR(room.indoor().area(), area, 1e-6);
    const Box2 box = bounds(room.indoor().parts.front().outline);
    EXPECT_LT(std::max(std::abs(box.low.x), std::abs(box.low.y)), 1.5);
    ASSERT_EQ(report.choices.size(), 1U);
    EXPECT_NE(report.choices[0].message.find("stands in surveyors' coordinates"),
              std::string::npos);
}

TEST(Surveyed, RosMaps) {
    const testing::TestFolder folder;
    std::string picture = "P5\n10 8\n255\n";
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 10; ++x)
            picture += static_cast<char>(x == 0 || y == 0 || x == 9 || y == 7 ? 0 : 254);
    writeAll(folder.file("base.pgm"), picture);
    ImportReport report;
    ImportOptions options;
    options.report = &report;
    options.clean = 0;
    expectMoved(readRosMap("image: base.pgm\nresolution: 0.5\n"
                           "origin: [448262.15, 5428611.7, 0]\nnegate: 0\n"
                           "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
                           folder.file("map.yaml"), options, sceneSchemas()),
                report, 12);
}

/// A cloud of the walls of a room of 6 m x 4 m, with these points beside it.
std::string cloudWith(const std::string& strays, int count) {
    std::string points;
    int sum = count;
    const auto add = [&](double x, double y) {
        for (int i = 0; i <= 10; ++i, ++sum)
            points += formatDouble(x) + ' ' + formatDouble(y) + ' ' + formatDouble(0.2 * i) + '\n';
    };
    for (int i = 0; i <= 300; ++i)
        for (const double y : {0.0, 4.0}) add(0.02 * i, y);
    for (int i = 0; i <= 200; ++i)
        for (const double x : {0.0, 6.0}) add(x, 0.02 * i);
    const std::string size = std::to_string(sum);
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
           size + "\nHEIGHT 1\nPOINTS " + size + "\nDATA ascii\n" + strays + points;
}

TEST(Strays, OfCloudsAreLeftOut) {
    ImportOptions options;
    options.slice_walls = 0.5;
    options.slice_top = 1.8;
    const Document document = readPointCloud(cloudWith("5000 5000 1\n-9000 20 1.2\n", 2), "hall",
                                             options, sceneSchemas());
    EXPECT_NEAR(environmentOf(document).indoor().area(), 24, 0.3);
    EXPECT_EQ(warningsOf(document),
              "hall: warning: 2 points lie far from all others, at (5000.0, 5000.0) and others: "
              "left out\n");
}

const char* const kUpper =
    " SOLID ROOM\n FACET NORMAL 0 0 0\n  OUTER LOOP\n   VERTEX 0 0 0\n   VERTEX 8 0 0\n"
    "   VERTEX 0 6E0 1\n  ENDLOOP\n ENDFACET\nENDSOLID ROOM\n";

std::string collada(const std::string& blank) {
    return "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/"
           "COLLADASchema\" version=\"1.4.1\"><asset><up_axis>Z_UP</up_axis></asset>"
           "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" "
           "count=\"9\">" +
           blank +
           "0 0 0 8 0 0 0 6 1</float_array><technique_common><accessor source=\"#a\" "
           "count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" "
           "type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common>"
           "</source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
           "<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>" +
           blank +
           "0 1 2</p></triangles></mesh></geometry></library_geometries>"
           "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><matrix>" +
           blank +
           "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url=\"#g\"/></node>"
           "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/>"
           "</scene></COLLADA>\n";
}

TEST(MeshSpelling, CapitalsInStlAndBlanksInCollada) {
    const testing::TestFolder folder;
    const auto corners = [&](const std::string& name, const std::string& text) {
        writeAll(folder.file(name), text);
        return loadMesh(folder.file(name), {})->vertices;
    };
    const auto wanted = corners("plain.dae", collada(""));
    ASSERT_EQ(wanted.size(), 3U);
    EXPECT_EQ(corners("upper.stl", kUpper), wanted);
    EXPECT_EQ(corners("blanks.dae", collada("\n   ")), wanted);
}

}  // namespace
}  // namespace ispace
