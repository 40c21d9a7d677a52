// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/numpy_file.h"

#include <gtest/gtest.h>

#include <cstring>

namespace ispace {
namespace numpy_file_test {

template <typename Number>
Number numberAt(std::string_view bytes, std::size_t at) {
    Number value{};
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
}

TEST(NpyHeader, IsAlignedAndSaysTypeAndShape) {
    using Shape = std::vector<std::uint64_t>;
    const std::pair<Shape, std::string> cases[] = {{{}, "()"},
                                                   {{5}, "(5,)"},
                                                   {{0, 6}, "(0, 6)"},
                                                   {{12345678901, 2, 3}, "(12345678901, 2, 3)"}};
    for (const auto& [shape, text] : cases) {
        const std::string header = npyHeader("<f4", shape);
        EXPECT_EQ(header.size() % 64, 0U);
        EXPECT_EQ(header.substr(0, 8), std::string("\x93NUMPY\1\0", 8));
        EXPECT_EQ(numberAt<std::uint16_t>(header, 8), header.size() - 10);
        EXPECT_EQ(header.back(), '\n');
        const std::string meant =
            "{'descr': '<f4', 'fortran_order': False, 'shape': " + text + ", }";
        EXPECT_EQ(header.substr(10, meant.size()), meant);
    }
}

TEST(Crc, OfTwoPiecesIsThatOfBoth) {
    EXPECT_EQ(crcOf("123456789"), 0xcbf43926U);
    EXPECT_EQ(crcOfBoth(crcOf("1234"), crcOf("56789"), 5), 0xcbf43926U);
    EXPECT_EQ(crcOfBoth(crcOf("1234"), crcOf(""), 0), crcOf("1234"));
}

TEST(ZipWriter, HasSizesOf64BitsOnlyWhereTheyAreNeeded) {
    std::string small;
    ZipWriter zip([&small](std::string_view bytes) { small += bytes; });
    zip.add("a", "alpha");
    zip.add("b", "");
    zip.finish();
    EXPECT_EQ(small.size(), 2 * (30 + 1) + 5 + 2 * (46 + 1) + 22U);

    // A hole of 5 GiB, then a file behind it.
    constexpr std::uint64_t kLarge = std::uint64_t{5} << 30U;
    const std::string piece(1U << 20U, 'x');
    std::string kept;
    ZipWriter large([&](std::string_view bytes) {
        if (bytes.data() != piece.data()) kept += bytes;
    });
    large.begin("large", kLarge, 7);
    for (std::uint64_t at = 0; at < kLarge; at += piece.size()) large.data(piece);
    large.add("behind", "end");
    large.finish();

    // The head of the large one.
    constexpr std::size_t kHead = 30 + 5;
    EXPECT_EQ(numberAt<std::uint32_t>(kept, 18), 0xffffffffU);
    EXPECT_EQ(numberAt<std::uint16_t>(kept, 28), 20);  // of extra fields
    EXPECT_EQ(numberAt<std::uint64_t>(kept, kHead + 4), kLarge);
    // The directory says where the other begins, and the end where the directory does.
    const std::uint64_t behind_at = kHead + 20 + kLarge;
    const std::size_t entry = kept.find("behind", kHead + 20 + 30 + 6 + 3);
    ASSERT_NE(entry, std::string::npos);
    EXPECT_EQ(numberAt<std::uint64_t>(kept, entry + 6 + 4), behind_at);
    const std::size_t end = kept.size() - 22, locator = end - 20, end64 = locator - 56;
    EXPECT_EQ(numberAt<std::uint32_t>(kept, end64), 0x06064b50U);
    EXPECT_EQ(numberAt<std::uint64_t>(kept, end64 + 48), behind_at + 30 + 6 + 3);
    EXPECT_EQ(numberAt<std::uint64_t>(kept, locator + 8), kLarge + end64);
}

}  // namespace numpy_file_test
}  // namespace ispace
