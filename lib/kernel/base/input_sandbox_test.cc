// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/run_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <system_error>

#include "base/file.h"
#include "support/test_folder.h"

namespace ispace {
namespace input_sandbox_test {

namespace fs = std::filesystem;

TEST(InputSandbox, KeepsReadersInItsFolders) {
    const testing::TestFolder folder;
    const fs::path root = fs::canonical(folder.path());
    fs::create_directories(root / "in/.hidden");
    for (const char* name : {"in/a", "in/.hidden/a", "in/.a", "out"})
        writeAll((root / name).string(), "x");
    fs::create_symlink("../out", root / "in/link");
    const auto name = [&](const char* file) { return (root / file).string(); };
    EXPECT_TRUE(mayBeRead(name("out")));
    {
        const InputSandbox fence({name("in")});
        EXPECT_EQ(readAll(name("in/a")), "x");
        EXPECT_EQ(readAll(name("in/.hidden/../a")), "x");
        for (const char* file : {"out", "in/../out", "in/link", "in/.a", "in/.hidden/a"}) {
            EXPECT_FALSE(mayBeRead(name(file))) << file;
            EXPECT_THROW(readAll(name(file)), std::system_error) << file;
            EXPECT_THROW(InputFile(name(file)), std::system_error) << file;
        }
        EXPECT_FALSE(mayBeRead("/dev/zero"));
        EXPECT_FALSE(mayBeRead("-"));
    }
    EXPECT_EQ(readAll(name("out")), "x");
    EXPECT_THROW(InputSandbox({name("none")}), std::system_error);
    EXPECT_TRUE(mayBeRead(name("out")));
}

}  // namespace input_sandbox_test
}  // namespace ispace
