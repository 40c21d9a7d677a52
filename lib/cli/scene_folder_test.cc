// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/scene_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "layout/schemas.h"
#include "record/text.h"

namespace ispace {
namespace {

namespace fs = std::filesystem;

/// A folder with scenes, and what lies beside it.
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
    ~SceneFolderTest() override { fs::remove_all(root_); }
    bool mayRead(const std::string& name) {
        try {
            static_cast<void>(folder().path(name));
            return true;
        } catch (const FormatError&) {
            return false;
        }
    }
    SceneFolder folder() { return {(root_ / "scenes").string(), false}; }
    fs::path root_ = fs::canonical(::testing::TempDir()) / "scene_folder_test";
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

}  // namespace
}  // namespace ispace
