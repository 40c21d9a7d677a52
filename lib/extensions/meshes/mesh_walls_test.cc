// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "base/file.h"
#include "base/number.h"
#include "extensions/meshes/mesh_parts.h"
#include "extensions/meshes/meshes_test.h"
#include "support/test_folder.h"
#include "support/test_import.h"

namespace ispace::meshes {
namespace mesh_walls_test {

/// A file of boxes as OBJ.
class Boxes {
  public:
    /// \param inner faces look inwards
    Boxes& add(double x0, double y0, double z0, double x1, double y1, double z1,
               bool inner = false) {
        for (const double z : {z0, z1})
            for (const auto& [x, y] :
                 {std::pair(x0, y0), std::pair(x1, y0), std::pair(x1, y1), std::pair(x0, y1)})
                text_ +=
                    "v " + formatDouble(x) + ' ' + formatDouble(y) + ' ' + formatDouble(z) + '\n';
        constexpr int kFaces[6][4] = {{4, 3, 2, 1}, {5, 6, 7, 8}, {1, 2, 6, 5},
                                      {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}};
        for (const auto& face : kFaces) {
            text_ += 'f';
            for (int i = 0; i < 4; ++i)
                text_ += ' ' + std::to_string(count_ + face[inner ? 3 - i : i]);
            text_ += '\n';
        }
        count_ += 8;
        return *this;
    }
    [[nodiscard]] std::string write(const testing::TestFolder& folder,
                                    const std::string& name) const {
        std::string path = folder.file(name);
        writeAll(path, text_);
        return path;
    }

  private:
    std::string text_;
    int count_ = 0;
};

ImportOptions cutAt(double height) {
    testing::addMeshesOnce();
    ImportOptions options;
    options.slice_walls = height;
    return options;
}

double areaOf(const Document& document) { return environmentOf(document).indoor().area(); }

TEST(MeshWalls, WallsThatRunIntoEachOther) {
    const testing::TestFolder folder;
    const std::string path = Boxes()
                                 .add(0, 0, 0, 6, 0.2, 3)
                                 .add(0, 4.2, 0, 6, 4.4, 3)
                                 .add(0, 0, 0, 0.2, 4.4, 3)
                                 .add(5.8, 0, 0, 6, 4.4, 3)
                                 .add(2, 2, 0, 3, 3, 0.7)
                                 .write(folder, "walls.obj");
    const Document high = readMeshWalls(path, cutAt(1), sceneSchemas());
    EXPECT_EQ(writeRecordText(high),
              "#env 1\nfence path=0.2,0.2;0.2,4.2;5.8,4.2;5.8,0.2 closed=yes\ninside at=3,2.2\n");
    EXPECT_NEAR(areaOf(readMeshWalls(path, cutAt(0.5), sceneSchemas())), 5.6 * 4 - 1, 1e-5);
}

TEST(MeshWalls, HollowShellAndInnerSurface) {
    const testing::TestFolder folder;
    const std::string shell = Boxes()
                                  .add(0, 0, 0, 6, 5, 3)
                                  .add(0.5, 0.5, 0.1, 5.5, 4.5, 2.9, true)
                                  .write(folder, "shell.obj");
    EXPECT_NEAR(areaOf(readMeshWalls(shell, cutAt(1.5), sceneSchemas())), 20, 1e-5);
    // A room as games have it: one surface, with what stands in it.
    const std::string surface =
        Boxes().add(0, 0, 0, 5, 4, 3, true).add(1, 1, 0, 2, 2, 2).write(folder, "surface.obj");
    EXPECT_NEAR(areaOf(readMeshWalls(surface, cutAt(1.5), sceneSchemas())), 19, 1e-5);
}

TEST(MeshWalls, WallsAndFurnitureAtAnInnerSurface) {
    const testing::TestFolder folder;
    const auto area_with = [&](double x0, double y0, double x1, double y1) {
        const std::string path =
            Boxes().add(0, 0, 0, 8, 6, 3, true).add(x0, y0, 0, x1, y1, 2).write(folder, "room.obj");
        return areaOf(readMeshWalls(path, cutAt(1), sceneSchemas()));
    };
    EXPECT_NEAR(area_with(4.9, 0, 5.1, 6), 4.9 * 6, 1e-5);       // divides the room
    EXPECT_NEAR(area_with(4.9, -0.1, 5.1, 6.1), 4.9 * 6, 1e-5);  // through its surface
    EXPECT_NEAR(area_with(4.9, 0, 5.1, 2), 48 - 0.2 * 2, 1e-5);  // a short wall
    EXPECT_NEAR(area_with(7, 5, 8, 6), 48 - 1, 1e-5);            // a box in a corner
    EXPECT_NEAR(area_with(7, 2, 8.05, 3), 48 - 1, 1e-5);         // and one in the surface
}

TEST(MeshWalls, UnitsAndHeights) {
    const testing::TestFolder folder;
    const std::string path = Boxes().add(0, 0, 0, 4000, 2500, 3000).write(folder, "room_mm.obj");
    ImportOptions options = cutAt(1.5);
    options.units = "mm";
    EXPECT_NEAR(areaOf(readMeshWalls(path, options, sceneSchemas())), 10, 1e-5);
    options.own.edit<UpAxis>().name = "y";
    EXPECT_NEAR(areaOf(readMeshWalls(path, options, sceneSchemas())), 12, 1e-5);
    options.slice_walls = 3.5;
    EXPECT_EQ(errorsOf([&] { readMeshWalls(path, options, sceneSchemas()); }),
              path +
                  ": error: nothing stands at 3.50 m: the mesh reaches from 0.00 m to 2.50 m; are "
                  "--slice-walls, --units and --up right?\n");
}

TEST(MeshWalls, StandardInputIsRefused) {
    EXPECT_EQ(errorsOf([] { readMeshWalls("-", cutAt(1), sceneSchemas()); }),
              "stdin: error: a mesh on standard input: name its file instead, as meshes are read "
              "from files alone\n");
}

TEST(MeshWalls, ACutThatEnclosesNoRoomWarns) {
    const testing::TestFolder folder;
    // Three walls of 0.4 m and an open side, wider than a doorway: only the walls are hollow.
    const std::string path = Boxes()
                                 .add(0, 0, 0, 6, 0.4, 3)
                                 .add(0, 0, 0, 0.4, 5, 3)
                                 .add(5.6, 0, 0, 6, 5, 3)
                                 .write(folder, "open.obj");
    EXPECT_NE(warningsOf(readMeshWalls(path, cutAt(1), sceneSchemas())).find("encloses no room"),
              std::string::npos);
    const std::string shut = Boxes()
                                 .add(0, 0, 0, 6, 0.4, 3)
                                 .add(0, 0, 0, 0.4, 5, 3)
                                 .add(5.6, 0, 0, 6, 5, 3)
                                 .add(0, 4.6, 0, 6, 5, 3)
                                 .write(folder, "shut.obj");
    EXPECT_EQ(warningsOf(readMeshWalls(shut, cutAt(1), sceneSchemas())), "");
}

TEST(ObjUpAxis, IsYUnlessACommentOrTheExtentSaysOtherwise) {
    const auto axis_of = [](double x, double y, double z, const std::string& head = "") {
        return objUpAxis(head + "v 0 0 0\nv " + formatDouble(x) + ' ' + formatDouble(y) + ' ' +
                             formatDouble(z) + "\nf 1 2 1\n",
                         1);
    };
    EXPECT_EQ(axis_of(4, 3, 4), "y");
    EXPECT_EQ(axis_of(4, 3, 2.5), "z");    // a room
    EXPECT_EQ(axis_of(2, 10, 2.5), "z");   // a corridor
    EXPECT_EQ(axis_of(0.5, 1, 0.5), "y");  // a chair
    EXPECT_EQ(axis_of(0.3, 4, 0.3), "y");  // a lamp post
    EXPECT_EQ(axis_of(4, 3, 4, "# ispace: metres, z up, x-y is the floor\n"), "z");
    EXPECT_EQ(axis_of(4, 3, 2.5, "# Y-up\n"), "y");
    EXPECT_EQ(objUpAxis("v 0 0 0\nv 4000 3000 2500\n", 0.001), "z");
    EXPECT_EQ(objUpAxis("v 0 0 0\nv 500 1000 500\n", 0.001), "y");
    EXPECT_EQ(objUpAxis("", 1), "y");
}

TEST(MeshWalls, CrossingsThatTakeLongAreRefusedAtOnce) {
    const testing::TestFolder folder;
    Boxes grid;
    constexpr int kBars = 300;
    for (int i = 0; i < kBars; ++i) {
        const double at = 20.0 * i / kBars;
        grid.add(at, 0, 0, at + 0.001, 20, 3).add(0, at, 0, 20, at + 0.001, 3);
    }
    const std::string path = grid.write(folder, "grid.obj");
    try {
        (void)readMeshWalls(path, cutAt(1), sceneSchemas());
        FAIL() << "90 000 crossings are read";
    } catch (const FormatError& error) {
        EXPECT_EQ(error.diagnostics().front().file, path);
        EXPECT_NE(std::string(error.what()).find("crossings of the cut's outlines make more than"),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace mesh_walls_test
}  // namespace ispace::meshes
