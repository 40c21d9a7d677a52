// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/run_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "support/test_folder.h"

namespace ispace {
namespace run_files_test {

namespace fs = std::filesystem;

/// A folder with a file `room`, its hard link `twin` and its symbolic link `link`.
class RunFilesTest : public ::testing::Test {
  protected:
    RunFilesTest() {
        writeAll(path("room"), "old");
        fs::create_hard_link(path("room"), path("twin"));
        fs::create_symlink("room", path("link"));
    }
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

    testing::TestFolder folder_;
};

template <typename Action>
std::string refusal(Action action) {
    try {
        action();
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST_F(RunFilesTest, NoOutputReplacesAnInputByAnyName) {
    const FileGuard files;
    (void)readAll(path("link"));
    for (const char* name : {"room", "twin", "link", "./room"}) {
        EXPECT_EQ(refusal([&] { writeAll(path(name), "new"); }),
                  path(name) + " is read by this command: write to another file");
        EXPECT_NE(refusal([&] { mustBeWritable(path(name)); }), "");
        EXPECT_NE(refusal([&] { claimOutput(path(name), "--output"); }), "");
    }
    EXPECT_EQ(readAll(path("room")), "old");
    writeAll(path("new"), "new");
}

TEST_F(RunFilesTest, NoClaimedOutputIsReadLater) {
    const FileGuard files;
    claimOutput(path("link"), "--output");
    const std::string expected = path("link") + " is read by this command: write to another file";
    EXPECT_EQ(refusal([&] { (void)readAll(path("room")); }), expected);
    EXPECT_EQ(refusal([&] { const InputFile file(path("twin")); }), expected);
    EXPECT_EQ(refusal([&] { noteInput(path("twin")); }), expected);
}

TEST_F(RunFilesTest, WhatAnOutputHasReplacedMayBeRead) {
    const FileGuard files;
    claimOutput(path("room"), "--output");
    writeAll(path("room"), "new");
    EXPECT_EQ(refusal([&] { EXPECT_EQ(readAll(path("twin")), "old"); }), "");
}

TEST_F(RunFilesTest, AnInputReadWhileTheOutputIsWritten) {
    const FileGuard files;
    OutputFile file(path("room"));
    EXPECT_NE(refusal([&] { (void)readAll(path("twin")); }), "");
}

TEST_F(RunFilesTest, LooksAgainBeforeTheRename) {
    const FileGuard files;
    noteInput(path("room"));
    OutputFile file(path("new"));
    fs::create_hard_link(path("room"), path("new"));
    EXPECT_NE(refusal([&] { file.commit(); }), "");
    EXPECT_EQ(readAll(path("new")), "old");
}

TEST_F(RunFilesTest, TwoOutputsAreTwoFiles) {
    const FileGuard files;
    fs::create_symlink("later", path("dangling"));
    claimOutput(path("later"), "--output");
    EXPECT_EQ(refusal([&] { claimOutput(path("dangling"), "-MF"); }),
              "-MF and --output name the same file, " + path("dangling"));
    fs::create_directory(path("sub"));
    EXPECT_NE(refusal([&] { claimOutput(path("sub/../later"), "-MF"); }), "");
    mustBeWritable(path("later"));
    writeAll(path("later"), "new");
    EXPECT_EQ(refusal([&] { writeAll(path("dangling"), "newer"); }),
              path("dangling") +
                  " is the name of two files that this command writes: give one of "
                  "them another name");
    EXPECT_EQ(readAll(path("later")), "new");
}

TEST_F(RunFilesTest, ACircleOfLinksIsNoFile) {
    fs::create_symlink("b", path("a"));
    fs::create_symlink("a", path("b"));
    EXPECT_THROW((void)followLinks(path("a")), std::system_error);
    EXPECT_THROW(writeAll(path("a"), "new"), std::system_error);
    EXPECT_TRUE(fs::is_symlink(path("a")));
}

TEST_F(RunFilesTest, TwoOpenOutputsAreTwoFiles) {
    const FileGuard files;
    std::optional<OutputFile> file(std::in_place, path("out"));
    EXPECT_NE(refusal([&] { const OutputFile second(path("out")); }), "");
    file.reset();
    writeAll(path("out"), "new");
}

TEST_F(RunFilesTest, StreamsAndDevicesDoNotCount) {
    const FileGuard files;
    const auto read = [&] {
        noteInput("-");
        noteInput("");
        noteInput(path("none"));
        (void)readAll("/dev/null");
    };
    const auto write = [&] {
        claimOutput("/dev/null", "--output");
        claimOutput("/dev/null", "--trace");
        claimOutput("-", "--output");
        claimOutput("", "--trace");
        claimOutput(path("no/folder/file"), "--curve");
        writeAll("/dev/null", "gone");
    };
    EXPECT_EQ(refusal(read), "");
    EXPECT_EQ(refusal(write), "");
    EXPECT_EQ(refusal(read), "") << "a device that was written";
}

TEST_F(RunFilesTest, WithoutARunNothingIsKept) {
    { const FileGuard files; }
    (void)readAll(path("room"));
    claimOutput(path("room"), "--output");
    writeAll(path("room"), "new");
    EXPECT_EQ(readAll(path("room")), "new");
    EXPECT_EQ(readAll(path("twin")), "old");
    const FileGuard files;
    EXPECT_EQ(refusal([&] { writeAll(path("room"), "newer"); }), "") << "of another run";
}

}  // namespace run_files_test
}  // namespace ispace
