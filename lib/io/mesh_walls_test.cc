// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/test_paths.h"
#include "io/importers.h"

#include <utility>

#include "base/file.h"
#include "base/number.h"
#include "io/test_import.h"

namespace ispace {
namespace {

const std::string kFlat = testing::sourcePath("tests/data/meshes/flat.ifc");

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
    [[nodiscard]] std::string write(const std::string& name) const {
        std::string path = ::testing::TempDir() + std::to_string(::getpid()) + name;
        writeAll(path, text_);
        return path;
    }

  private:
    std::string text_;
    int count_ = 0;
};

ImportOptions cutAt(double height) {
    ImportOptions options;
    options.slice_walls = height;
    return options;
}

double areaOf(const Document& document) { return environmentOf(document).indoor().area(); }

TEST(MeshWalls, WallsThatRunIntoEachOther) {
    const std::string path = Boxes()
                                 .add(0, 0, 0, 6, 0.2, 3)
                                 .add(0, 4.2, 0, 6, 4.4, 3)
                                 .add(0, 0, 0, 0.2, 4.4, 3)
                                 .add(5.8, 0, 0, 6, 4.4, 3)
                                 .add(2, 2, 0, 3, 3, 0.7)
                                 .write("walls.obj");
    const Document high = readMeshWalls(path, cutAt(1), sceneSchemas());
    EXPECT_EQ(writeRecordText(high),
              "#env 1\nfence path=0.2,0.2;0.2,4.2;5.8,4.2;5.8,0.2 closed=yes\ninside at=3,2.2\n");
    EXPECT_NEAR(areaOf(readMeshWalls(path, cutAt(0.5), sceneSchemas())), 5.6 * 4 - 1, 1e-5);
}

TEST(MeshWalls, HollowShellAndInnerSurface) {
    const std::string shell =
        Boxes().add(0, 0, 0, 6, 5, 3).add(0.5, 0.5, 0.1, 5.5, 4.5, 2.9, true).write("shell.obj");
    EXPECT_NEAR(areaOf(readMeshWalls(shell, cutAt(1.5), sceneSchemas())), 20, 1e-5);
    // A room as games have it: one surface, with what stands in it.
    const std::string surface =
        Boxes().add(0, 0, 0, 5, 4, 3, true).add(1, 1, 0, 2, 2, 2).write("surface.obj");
    EXPECT_NEAR(areaOf(readMeshWalls(surface, cutAt(1.5), sceneSchemas())), 19, 1e-5);
}

TEST(MeshWalls, UnitsAndHeights) {
    const std::string path = Boxes().add(0, 0, 0, 4000, 2500, 3000).write("room_mm.obj");
    ImportOptions options = cutAt(1.5);
    options.units = "mm";
    EXPECT_NEAR(areaOf(readMeshWalls(path, options, sceneSchemas())), 10, 1e-5);
    options.up = "y";
    EXPECT_NEAR(areaOf(readMeshWalls(path, options, sceneSchemas())), 12, 1e-5);
    options.slice_walls = 3.5;
    EXPECT_EQ(errorsOf([&] { readMeshWalls(path, options, sceneSchemas()); }),
              path +
                  ": error: nothing stands at 3.50 m: the mesh reaches from 0.00 m to 2.50 m; are "
                  "--slice-walls, --units and --up right?\n");
}

Document readFlat(const ImportOptions& options = {}) {
    return readIfc(readAll(kFlat), kFlat, options, sceneSchemas());
}

TEST(Ifc, Known) {
    EXPECT_TRUE(isIfc(readAll(kFlat)));
    EXPECT_FALSE(
        isIfc("ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\n#1=IFCWALL();"));
    EXPECT_FALSE(isIfc("FILE_SCHEMA(('IFC4'));"));
    EXPECT_FALSE(isIfc(""));
}

TEST(Ifc, StoreyWithDoorsAndWindow) {
    const Document flat = readFlat();
    // Two rooms, and their share of what lies in the doors and the window of walls of 0.24 m.
    EXPECT_NEAR(areaOf(flat), 3 * 4 + 2 * 4 + 0.8 * 0.24 + (0.9 + 1.2) * 0.12, 1e-4);
    EXPECT_EQ(countOf(flat, "door"), 2U);
    EXPECT_EQ(countOf(flat, "window"), 1U);
    EXPECT_EQ(notesOf(flat),
              "cut at a height of 1.70 m\n"
              "layers of walls: IfcWallStandardCase (2)\n"
              "layers of doors: IfcDoor (2)\n"
              "layers of windows: IfcWindow (1)\n"
              "layers left out: IfcFurnishingElement (1)\n"
              "kept the largest region, 20.4 m2 in 2 rooms\n"
              "2 doors, 1 window\n"
              "left out outside of it: 6 lines and 0 openings\n");
}

TEST(Ifc, LayersAndHeight) {
    ImportOptions options;
    options.wall_layers = {"IfcWall*", "IfcFurnishing*"};
    EXPECT_NEAR(areaOf(readFlat(options)), 20.444 - 0.36, 1e-4);
    options.slice_walls = 3.7;  // the storey above has one wall
    EXPECT_NEAR(areaOf(readFlat(options)), 5.72 * 0.24, 1e-4);
    options.slice_walls = 30;
    EXPECT_EQ(errorsOf([&] { readFlat(options); }),
              kFlat +
                  ": error: nothing stands at 30.00 m: the building reaches from "
                  "0.50 m to 6.30 m; say another height with --slice-walls\n");
}

TEST(Ifc, RefusesWhatIsDamaged) {
    const std::string whole = readAll(kFlat);
    const std::string path = ::testing::TempDir() + std::to_string(::getpid()) + "damaged.ifc";
    const auto error_of = [&](const std::string& bytes) {
        writeAll(path, bytes);
        return errorsOf([&] { readIfc(bytes, path, {}, sceneSchemas()); });
    };
    EXPECT_EQ(error_of(whole.substr(0, whole.size() / 2)),
              path + ": error: truncated: the building ends without `END-ISO-10303-21;`\n");
    // A reference to what is missing crashes assimp 5.2, which is not us.
    std::string dangling = whole;
    const std::size_t line = dangling.find("=IFCRECTANGLEPROFILEDEF");
    dangling[line + 4] = 'X';
    EXPECT_EQ(error_of(dangling).find(path + ": error: bad "), 0U) << error_of(dangling);
    const std::string nothing =
        whole.substr(0, whole.find("DATA;") + 6) + "ENDSEC;\nEND-ISO-10303-21;\n";
    EXPECT_EQ(error_of(nothing).find(path + ": error: bad mesh file: "), 0U) << error_of(nothing);
    EXPECT_NE(errorsOf([&] { readIfc(whole, "-", {}, sceneSchemas()); }).find("standard input"),
              std::string::npos);
}

}  // namespace
}  // namespace ispace
