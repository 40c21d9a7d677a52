// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/numpy_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "support/test_folder.h"

namespace ispace {
namespace spool_test {

std::string contentOf(const Spool& spool) {
    std::string out;
    spool.copyTo([&out](std::string_view bytes) { out += bytes; });
    return out;
}

/// Not the same anywhere.
std::string bytesOf(std::size_t count, std::size_t from = 0) {
    std::string out(count, '\0');
    for (std::size_t i = 0; i < count; ++i)
        out[i] = static_cast<char>((from + i) * 2654435761U >> 13U);
    return out;
}

TEST(Spool, KeepsFewBytesAndMany) {
    for (const std::size_t count : {0U, 5U, 1U << 20U, 5'000'000U}) {
        Spool spool;
        std::string all;
        for (std::size_t at = 0; at < count; at += 70'001) {
            const std::string piece = bytesOf(std::min<std::size_t>(70'001, count - at), at);
            spool.append(piece);
            all += piece;
        }
        EXPECT_EQ(spool.size(), count);
        EXPECT_EQ(spool.crc(), crcOf(all));
        EXPECT_TRUE(contentOf(spool) == all) << count;
        EXPECT_TRUE(contentOf(spool) == all) << "a second time";
        spool.append("more");
        EXPECT_TRUE(contentOf(spool) == all + "more");
    }
}

/// TMPDIR for a while.
class Folder {
  public:
    explicit Folder(const char* name) {
        // NOLINTNEXTLINE(concurrency-mt-unsafe)
        ::setenv("TMPDIR", name, 1);
    }
    // NOLINTNEXTLINE(concurrency-mt-unsafe)
    ~Folder() { ::unsetenv("TMPDIR"); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

TEST(Spool, TellsOfAFolderThatIsNone) {
    const Folder none("/nowhere/at/all");
    Spool spool;
    spool.append("few bytes need no file");
    try {
        spool.append(bytesOf(2U << 20U));
        FAIL();
    } catch (const std::system_error& error) {
        EXPECT_NE(std::string(error.what()).find("the folder TMPDIR"), std::string::npos)
            << error.what();
    }
}

TEST(Spool, LeavesNothingBehind) {
    const testing::TestFolder folder;
    const std::string name = folder.path().string();
    {
        const Folder here(name.c_str());
        Spool spool;
        spool.append(bytesOf(3U << 20U));
        EXPECT_TRUE(std::filesystem::is_empty(name));
    }
    EXPECT_TRUE(std::filesystem::is_empty(name));
}

}  // namespace spool_test
}  // namespace ispace
