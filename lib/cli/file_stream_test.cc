// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/file_stream.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <system_error>

namespace ispace {
namespace {

TEST(FileStream, WritesWhatGoesThrough) {
    const std::string file = ::testing::TempDir() + "file_stream_test.txt";
    std::string expected;
    {
        FileStream out(file);
        for (int i = 0; i < 300000; ++i) {  // more than its buffer
            out.stream() << i << '\n';
            expected.append(std::to_string(i)).append("\n");
        }
        out.commit();
    }
    EXPECT_EQ(readAll(file), expected);
    std::remove(file.c_str());
}

TEST(FileStream, LeavesNothingWithoutCommit) {
    const std::string file = ::testing::TempDir() + "file_stream_test.none";
    { FileStream(file).stream() << "half"; }
    EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(FileStream, AFullDiskIsAnError) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    FileStream out("/dev/full");
    const auto fill = [&out] {
        const std::string line(1000, 'x');
        for (int i = 0; i < 3000; ++i) out.stream() << line;
        out.commit();
    };
    EXPECT_THROW(fill(), std::system_error);
}

}  // namespace
}  // namespace ispace
