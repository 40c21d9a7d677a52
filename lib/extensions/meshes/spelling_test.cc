// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds with strays far away, and meshes as other programs spell them.
#include <gtest/gtest.h>

#include <string>

#include "base/file.h"
#include "base/number.h"
#include "extensions/meshes/meshes_test.h"
#include "io/mesh_files.h"
#include "support/test_folder.h"
#include "support/test_import.h"

namespace ispace::meshes {
namespace spelling_test {

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
    testing::addMeshesOnce();
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

}  // namespace spelling_test
}  // namespace ispace::meshes
