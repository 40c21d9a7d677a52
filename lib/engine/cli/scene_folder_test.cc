// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/scene_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_folder.h"

namespace ispace {
namespace scene_folder_test {

namespace fs = std::filesystem;

/// A folder with scenes, and files beside it.
class SceneFolderTest : public ::testing::Test {
  protected:
    SceneFolderTest() {
        fs::remove_all(root_);
        fs::create_directories(root_ / "scenes/sub");
        fs::create_directories(root_ / "scenes/.git");
        fs::create_directories(root_ / "scenes2");
        for (const char* name : {"scenes/room.env", "scenes/sub/room.env", "scenes/.git/room.env",
                                 "scenes/.env", "scenes2/room.env", "secret.env"})
            writeAll((root_ / name).string(), "#env 1\nispace size=4,4\n");
        fs::create_symlink("../secret.env", root_ / "scenes/link.env");
        fs::create_symlink("room.env", root_ / "scenes/alias.env");
        ::mkfifo((root_ / "scenes/pipe.env").c_str(), 0600);
    }
    bool mayRead(const std::string& name) {
        try {
            static_cast<void>(folder().path(name));
            return true;
        } catch (const FormatError&) {
            return false;
        }
    }
    SceneFolder folder() { return {(root_ / "scenes").string(), {false}}; }
    testing::TestFolder folder_;
    fs::path root_ = fs::canonical(folder_.path());
};

TEST_F(SceneFolderTest, ReadsWhatLiesInIt) {
    for (const std::string& name :
         {std::string("room.env"), std::string("sub/room.env"), std::string("./sub/../room.env"),
          std::string("alias.env"), (root_ / "scenes/room.env").string()})
        EXPECT_TRUE(mayRead(name)) << name;
}

TEST_F(SceneFolderTest, AndNothingElse) {
    for (const std::string& name :
         {std::string("missing.env"), std::string("../secret.env"), std::string("link.env"),
          std::string("../scenes2/room.env"), (root_ / "secret.env").string(),
          std::string("pipe.env"), std::string("sub"), std::string("."), std::string(""),
          std::string(".env"), std::string(".git/room.env"), std::string("-"),
          std::string("/dev/stdin"), std::string("/dev/zero"), std::string("/etc/passwd")})
        EXPECT_FALSE(mayRead(name)) << name;
}

TEST_F(SceneFolderTest, LoadsScenes) {
    EXPECT_EQ(folder().load("room.env", "").ids, (std::vector<std::string>{"ispace1"}));
    writeAll((root_ / "scenes/room.3dm").string(), "#3dm 1\nrobot id=r1\n");
    EXPECT_EQ(folder().load("room.env", "room.3dm").robots.size(), 1U);
    EXPECT_THROW(static_cast<void>(folder().load("room.env", "link.env")), FormatError);
}

/// The errors that clients get for these scenes.
std::string errorOf(const SceneFolder& folder, const std::string& env, const std::string& layout) {
    try {
        static_cast<void>(folder.load(env, layout));
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

TEST_F(SceneFolderTest, WhatScenesNameLiesInItToo) {
    const auto write = [&](const std::string& name, const std::string& text) {
        writeAll((root_ / name).string(), text);
    };
    write("secret.yaml", "- ispace: {size: [4, 4]}\n");
    write("secret.pgm", "P2 2 2 255 0 0 0 0\n");
    write("secret.stl", "solid root\nendsolid root\n");
    write("scenes/own.yaml", "- ispace: {size: [4, 4]}\n");
    const std::string room = "#env 1\nispace size=4,4\n", layout = "#3dm 1\n";
    const std::string map = "resolution: 1\norigin: [0, 0, 0]\nimage: ";
    write("scenes/include_own.yaml", "include: own.yaml\n");
    EXPECT_EQ(errorOf(folder(), "include_own.yaml", ""), "");
    write("scenes/include.yaml", "include: ../secret.yaml\n");
    write("scenes/map.yaml", map + "../secret.pgm\n");
    write("scenes/mesh.env", room + "mesh file=../secret.stl at=0,0\n");
    write("scenes/anywhere.env", room + "mesh file=../secret.stl at=0,0 side_files=anywhere\n");
    write("scenes/texture.env", room + "cube at=0,0 size=1 texture=../secret.pgm\n");
    for (const char* env :
         {"include.yaml", "map.yaml", "mesh.env", "anywhere.env", "texture.env"}) {
        const std::string outside = errorOf(folder(), env, "");
        EXPECT_NE(outside, "") << env;
        EXPECT_EQ(outside.find(root_.string()), std::string::npos) << outside;
    }
    write("scenes/e.3dm", layout + "environment file=../secret.env\n");
    EXPECT_THROW(static_cast<void>(folder().load("e.3dm", "")), FormatError);
    write("scenes/e.3dm", layout + "environment file=room.env\n");
    EXPECT_EQ(folder().load("e.3dm", "").ids.size(), 1U);
}

TEST_F(SceneFolderTest, ErrorsNameFilesAsWrittenAndTellOfScenesOnly) {
    writeAll((root_ / "scenes/bad.env").string(), "#env 1\nispase size=4,4\n");
    const std::string bad = ":2:1: error: unknown keyword `ispase`, did you mean `ispace`?";
    EXPECT_EQ(errorOf(folder(), "bad.env", ""), "bad.env" + bad);
    EXPECT_EQ(errorOf(folder(), "sub/../bad.env", ""), "sub/../bad.env" + bad);
    EXPECT_EQ(errorOf(folder(), "room.env", "sub/room.env"),
              "two environments given, one is wanted: sub/room.env");
    for (const std::string text : {"password: geheim\n", "geheim", "P2 geheim", "solid geheim\n"}) {
        writeAll((root_ / "scenes/notes.txt").string(), text);
        const std::string error = errorOf(folder(), "notes.txt", "");
        EXPECT_TRUE(error.starts_with("notes.txt:")) << error;
        EXPECT_EQ(error.find("geheim"), std::string::npos) << error;
    }
}

TEST_F(SceneFolderTest, IsThere) {
    for (const auto& [name, why] : {std::pair("missing", "No such file or directory"),
                                    std::pair("secret.env", "Not a directory")}) {
        const std::string folder = (root_ / name).string();
        try {
            SceneFolder(folder, {false});
            FAIL() << folder;
        } catch (const std::system_error& error) {
            EXPECT_EQ(error.what(), folder + ": " + why);
        }
    }
}

TEST_F(SceneFolderTest, FilesOfRecordsLieInItToo) {
    const auto record = [](const std::string& line) {
        return readRecord(line, "request", sceneSchemas());
    };
    Record cube = record("cube at=0,0 size=1 texture=room.env");
    folder().loadFilesOf(cube);
    EXPECT_EQ(cube.text("texture"), (root_ / "scenes/room.env").string());
    Record outside = record("cube at=0,0 size=1 texture=../secret.env");
    EXPECT_THROW(folder().loadFilesOf(outside), FormatError);
    Record mesh = record("mesh file=room.obj at=0,0 side_files=anywhere");
    EXPECT_THROW(folder().loadFilesOf(mesh), FormatError);
}

}  // namespace scene_folder_test
}  // namespace ispace
