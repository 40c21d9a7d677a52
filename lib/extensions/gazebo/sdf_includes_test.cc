// SPDX-License-Identifier: GPL-3.0-or-later
// Models that a world of SDF includes: where they are found, and where they stand.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "extensions/gazebo/gazebo.h"
#include "extensions/gazebo/model_path.h"
#include "extensions/gazebo/sdf_files.h"
#include "extensions/meshes/meshes_test.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_folder.h"

namespace ispace::gazebo {
namespace sdf_includes_test {

namespace fs = std::filesystem;

/// A folder with the files of a world.
class SdfIncludes : public ::testing::Test {
  protected:
    void put(const std::string& path, const std::string& text) const {
        fs::create_directories(fs::path(folder_ + path).parent_path());
        writeAll(folder_ + path, text);
    }
    /// `NAME/model.sdf` with a box of 1 m x 0.5 m x 1 m, and whatever else.
    void putModel(const std::string& name, const std::string& more = "") const {
        put(name + "/model.sdf", "<sdf version='1.9'><model name='" + name +
                                     "'><link name='l'><collision name='c'><geometry><box><size>1 "
                                     "0.5 1</size></box></geometry></collision></link>\n" +
                                     more + "</model></sdf>");
    }
    static std::string include(const std::string& uri, const std::string& more = "") {
        return "<include><uri>" + uri + "</uri>" + more + "</include>\n";
    }
    [[nodiscard]] Document read(const std::string& content,
                                const ImportOptions& options = {}) const {
        return readSdf("<sdf version='1.9'><world name='w'>\n" + content + "</world></sdf>",
                       folder_ + "w.sdf", options, sceneSchemas());
    }
    [[nodiscard]] std::string recordsOf(const std::string& content) const {
        const std::string text = writeRecordText(read(content));
        return text.substr(text.find('\n') + 1);
    }
    /// With the folder's name left out.
    [[nodiscard]] std::string errorOf(const std::string& content) const {
        try {
            (void)read(content);
        } catch (const FormatError& error) {
            std::string text = error.what();
            for (std::size_t at = 0; (at = text.find(folder_)) != std::string::npos;)
                text.erase(at, folder_.size());
            return text;
        }
        return "no error";
    }

    const testing::TestFolder temporary_;
    const std::string folder_ = temporary_.file("");
};

TEST_F(SdfIncludes, ModelsStandWhereTheIncludePutsThem) {
    putModel("crate");
    EXPECT_EQ(recordsOf(include("model://crate", "<pose>2 3 0.5 0 0 0</pose>") +
                        include("model://crate",
                                "<name>b</name><pose relative_to='crate'>"
                                "1 0 0 0 0 1.5708</pose>")),
              "cube id=crate at=2,3 size=1,0.5,1\n"
              "cube id=b at=3,3 heading=90 size=1,0.5,1\n");
    // Without one where the model puts itself.
    putModel("own", "<pose>4 5 0.5 0 0 0</pose>");
    EXPECT_EQ(recordsOf(include("model://own")), "cube id=own at=4,5 size=1,0.5,1\n");
}

TEST_F(SdfIncludes, PlacementFramesAreTheIncludesBeforeTheModels) {
    putModel("crate",
             "<frame name='end'><pose>0.5 0 -0.5 0 0 0</pose></frame>"
             "<frame name='side'><pose>0 1 -0.5 0 0 0</pose></frame>");
    EXPECT_EQ(recordsOf(include("model://crate",
                                "<pose>2 3 0 0 0 0</pose>"
                                "<placement_frame>end</placement_frame>")),
              "cube id=crate at=1.5,3 size=1,0.5,1\n");
    // A name stands for the model's own frame, also where another one was placed.
    EXPECT_EQ(recordsOf(include("model://crate",
                                "<pose>2 3 0 0 0 0</pose>"
                                "<placement_frame>end</placement_frame>") +
                        include("model://crate",
                                "<name>b</name><pose relative_to='crate'>"
                                "0 2 0 0 0 0</pose>")),
              "cube id=crate at=1.5,3 size=1,0.5,1\n"
              "cube id=b at=1.5,5 size=1,0.5,1\n");
}

TEST_F(SdfIncludes, FramesOfModelsInModelsAreNotMixedUp) {
    // The outer model is placed by a frame in the inner one, which is looked up before the outer
    // model has a place.
    EXPECT_EQ(recordsOf("<model name='o' placement_frame='i::f'><pose>5 5 0 0 0 0</pose>"
                        "<model name='i'><pose>1 0 0.5 0 0 0</pose><frame name='f'><pose>0 0 -0.5 "
                        "0 0 0</pose></frame><link name='l'><collision name='c'><geometry><box>"
                        "<size>1 0.5 1</size></box></geometry></collision></link></model></model>"),
              "cube id=o at=5,5 size=1,0.5,1\n");
}

TEST_F(SdfIncludes, MergedModelsLendTheirFrames) {
    putModel("crate");
    EXPECT_EQ(recordsOf("<model name='m'><pose>1 1 0.5 0 0 0</pose><include merge='true'><uri>"
                        "model://crate</uri><pose>1 0 0 0 0 0</pose></include>"
                        "<link name='k'><pose relative_to='l'>0 2 0 0 0 0</pose><visual name='v'>"
                        "<geometry><box><size>1 0.4 1</size></box></geometry></visual></link>"
                        "</model>"),
              "cube id=m at=2,3 size=1,0.4,1\n"
              "cube id=m-2 at=2,1 size=1,0.5,1\n");
}

TEST_F(SdfIncludes, FilesAreFoundInTheFolderOrBelow) {
    putModel("crate");
    putModel("models/deep");
    const std::string box = "size=1,0.5,0.5\n";
    EXPECT_EQ(recordsOf(include("crate")), "cube id=crate " + box);
    EXPECT_EQ(recordsOf(include("crate/model.sdf")), "cube id=crate " + box);
    EXPECT_EQ(recordsOf(include("file://crate")), "cube id=crate " + box);
    EXPECT_EQ(recordsOf(include(folder_ + "crate")), "cube id=crate " + box);
    EXPECT_EQ(recordsOf(include("package://crate/model.sdf")), "cube id=crate " + box);
    EXPECT_EQ(recordsOf(include("model://deep", "<name>d</name>")), "cube id=d " + box);
    EXPECT_EQ(recordsOf(include("https://fuel.gazebosim.org/1.0/openrobotics/models/crate/2")),
              "cube id=crate " + box);
    // Paths are relative to the file that holds them.
    put("models/set/model.sdf",
        "<sdf><model name='s'><include><uri>parts/p.sdf</uri></include>"
        "<include><uri>model://deep</uri></include></model></sdf>");
    put("models/set/parts/p.sdf",
        "<sdf><model name='p'><include><uri>model://crate</uri>"
        "</include></model></sdf>");
    const Document document = read(include("model://set"));
    EXPECT_EQ(document.records.size(), 2U);
    EXPECT_EQ(document.sources,
              (std::vector<std::string>{
                  folder_ + "models/set/model.sdf", folder_ + "models/set/parts/p.sdf",
                  folder_ + "models/deep/model.sdf", folder_ + "crate/model.sdf"}));
}

/// A world in `worlds` of a package, whose models lie beside that.
class SdfPackages : public SdfIncludes {
  protected:
    SdfPackages() { fs::create_directories(folder_ + "worlds"); }
    [[nodiscard]] std::string idsOf(const std::string& content,
                                    const std::vector<std::string>& folders = {}) const {
        ImportOptions options;
        options.own.edit<ModelFolders>().folders = folders;
        std::string ids;
        for (const Record& record :
             readSdf("<sdf version='1.9'><world name='w'>" + content + "</world></sdf>",
                     folder_ + "worlds/w.sdf", options, sceneSchemas())
                 .records)
            ids += record.text("id") + ' ';
        return ids;
    }
};

TEST_F(SdfPackages, ModelsLieBesideTheWorldsFolderAndWhereTheUserSays) {
    putModel("models/shelf");
    put("models/lamp/model.sdf",
        "<sdf><model name='lamp'><include><uri>model://lamp/foot</uri></include></model></sdf>");
    putModel("models/lamp/foot");
    putModel("elsewhere/crate");
    EXPECT_EQ(idsOf(include("model://shelf")), "models-shelf ");
    EXPECT_EQ(idsOf(include("file://shelf")), "models-shelf ");
    EXPECT_EQ(idsOf(include("package://my_gazebo/models/shelf")), "models-shelf ");
    EXPECT_EQ(idsOf(include("file:///home/of/someone/models/shelf/model.sdf")), "models-shelf ");
    EXPECT_EQ(idsOf(include("model://lamp")), "lamp ");
    EXPECT_EQ(idsOf(include("model://crate"), {folder_ + "none", folder_ + "elsewhere"}),
              "elsewhere-crate ");
    EXPECT_THROW((void)idsOf(include("model://crate")), FormatError);
}

// As Gazebo finds it with the package among its resources.
TEST_F(SdfPackages, FilesMayBeNamedFromThePackageOn) {
    putModel("models/shelf");
    EXPECT_EQ(idsOf(include("file://models/shelf")), "models-shelf ");
}

TEST_F(SdfPackages, TheWorldsOwnFolderComesFirstAndNoOtherIsOpen) {
    putModel("models/crate", "<link name='m'/>");
    put("worlds/crate/model.sdf",
        "<sdf><model name='near'><link name='l'><collision name='c'><geometry><box><size>1 1 1"
        "</size></box></geometry></collision></link></model></sdf>");
    putModel("elsewhere/crate");
    EXPECT_EQ(idsOf(include("model://crate"), {folder_ + "elsewhere"}), "near ");
    // What lies beside a folder of models stays closed, links followed.
    putModel("secret");
    fs::create_symlink(folder_ + "secret", folder_ + "models/link");
    for (const char* uri : {"model://../secret", "model://link", "../secret", "file://../secret"})
        EXPECT_THROW((void)idsOf(include(uri)), FormatError) << uri;
}

TEST_F(SdfIncludes, TheLatestVersionIsRead) {
    putModel("crate");
    put("crate/old.sdf", "no SDF at all");
    put("crate/model.config",
        "<model><sdf version='1.9'>old.sdf</sdf><sdf version='1.10'> "
        "model.sdf </sdf><sdf>old.sdf</sdf></model>");
    EXPECT_EQ(recordsOf(include("model://crate")), "cube id=crate size=1,0.5,0.5\n");
    put("crate/model.config", "<model><sdf");
    EXPECT_NE(errorOf(include("model://crate")).find("crate/model.config:1:1: error: bad XML"),
              std::string::npos);
}

TEST_F(SdfIncludes, MeshesLieBesideTheModel) {
    testing::addMeshesOnce();
    put("lamp/foot.stl",
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid\n");
    put("lamp/model.sdf",
        "<sdf><model name='lamp'><link name='l'><visual name='v'><geometry><mesh>"
        "<uri>foot.stl</uri></mesh></geometry></visual></link></model></sdf>");
    EXPECT_NE(recordsOf(include("model://lamp", "<pose>1 2 0 0 0 0</pose>")).find("lamp/foot.stl"),
              std::string::npos);
}

TEST_F(SdfIncludes, RoomsLackFurnitureThatIsMissing) {
    std::string walls;
    for (const char* wall : {"0 3 1 0 0 0</pose><geometry><box><size>6 0.2 2",
                             "0 -3 1 0 0 0</pose><geometry><box><size>6 0.2 2",
                             "3 0 1 0 0 0</pose><geometry><box><size>0.2 6.2 2",
                             "-3 0 1 0 0 0</pose><geometry><box><size>0.2 6.2 2"})
        walls += "<collision name='w" + std::to_string(walls.size()) + "'><pose>" +
                 std::string(wall) + "</size></box></geometry></collision>";
    walls = "<model name='walls'><link name='l'>" + walls + "</link></model>";
    EXPECT_EQ(errorOf(walls + include("model://lost")), "no error");
    EXPECT_NE(recordsOf(walls + include("model://lost")).find("wall "), std::string::npos);
}

TEST_F(SdfIncludes, WhatIsMissingIsNamedOnceWithItsPlace) {
    putModel("crate");
    EXPECT_EQ(errorOf(include("model://crate") + include("model://a") + include("model://b") +
                      include("model://a")),
              "w.sdf:3:1: error: `model://a`, `model://b` are not in the world's folder, in "
              "../models or below: say with --models DIR (or GAZEBO_MODEL_PATH) which folder "
              "holds the models, write the world with everything in it (`gz sdf -p`), or delete "
              "the `include`");
    EXPECT_EQ(errorOf("<include/>"), "w.sdf:2:1: error: `include` without `uri`");
    putModel("table", "\n\n" + include("model://leg"));
    EXPECT_EQ(
        errorOf(include("model://table")).find("table/model.sdf:4:1: error: `model://leg` is "),
        0U);
    // No file outside is read, whatever leads there.
    for (const char* uri : {"../../../../../../etc/passwd", "/etc/passwd", "file:///etc/passwd",
                            "model://../../etc/passwd", "https://example.org/models/../../etc"})
        EXPECT_NE(errorOf(include(uri)).find(" is not in the world's folder, "), std::string::npos)
            << uri;
    fs::create_symlink("/etc", folder_ + "link");
    EXPECT_NE(errorOf(include("model://link/passwd")).find(" is not in the world's folder"),
              std::string::npos);
    // A sun and a ground are nothing to stand in a room.
    EXPECT_EQ(errorOf(include("model://sun") + include("model://ground_plane") +
                      include("https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground Plane") +
                      include("model://crate")),
              "no error");
}

TEST_F(SdfIncludes, LightsAndWorldsAreNoModels) {
    put("lamp/model.sdf", "<sdf><light name='x' type='point'/></sdf>");
    putModel("crate");
    const Document document = read(include("model://lamp") + include("model://crate"));
    EXPECT_EQ(document.records.size(), 1U);
    EXPECT_NE(document.notes.front().find("light (1)"), std::string::npos)
        << document.notes.front();
    put("world/model.sdf", "<sdf><world name='w'/></sdf>");
    EXPECT_EQ(errorOf(include("model://world")),
              "world/model.sdf:1:1: error: no `model` in it, but a world includes it");
}

TEST_F(SdfIncludes, CirclesEnd) {
    putModel("a", include("model://b"));
    putModel("b", include("model://a"));
    EXPECT_EQ(errorOf(include("model://a")),
              "b/model.sdf:2:1: error: files include each other in a circle: a/model.sdf "
              "-> b/model.sdf -> a/model.sdf");
    putModel("self", include("model://self"));
    EXPECT_NE(errorOf(include("model://self")).find("in a circle"), std::string::npos);
    // Both are loaded before either is entered.
    EXPECT_EQ(errorOf(include("model://b") + include("model://a")),
              "a/model.sdf:2:1: error: files include each other in a circle: b/model.sdf "
              "-> a/model.sdf -> b/model.sdf");
    // Each includes the next twice.
    for (int i = 0; i < 20; ++i) {
        const std::string next = "n" + std::to_string(i + 1);
        putModel("n" + std::to_string(i),
                 include("model://" + next) + include("model://" + next, "<name>again</name>"));
    }
    putModel("n20");
    EXPECT_NE(errorOf(include("model://n0")).find("what the world includes and repeats makes more"),
              std::string::npos);
}

}  // namespace sdf_includes_test
}  // namespace ispace::gazebo
