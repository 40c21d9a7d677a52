// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/zstd_text.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/test_folder.h"

namespace ispace {
namespace zstd_text_test {

class ZstdText : public ::testing::Test {
  protected:
    [[nodiscard]] std::string read(const std::string& bytes, const std::string& name = "a.zst") {
        writeAll(folder_.file(name), bytes);
        TextFile file(folder_.file(name));
        std::string text;
        while (file.read(text)) continue;
        return text;
    }

    testing::TestFolder folder_;
};

/// Lines of a table, which hardly repeat each other.
std::string lines(int first, int count) {
    std::string text;
    for (int i = first; i < first + count; ++i)
        text += std::to_string(i) + ",r" + std::to_string(i % 7) + ',' +
                std::to_string(static_cast<double>(i) * 0.7310585786) + '\n';
    return text;
}

TEST_F(ZstdText, GivesEachPieceAtOnce) {
    ZstdPacker packer;
    std::string bytes, text;
    for (int i = 0; i < 12; ++i) {
        const std::string piece = lines(1000 * i, i % 3 == 0 ? 1 : 9000);
        bytes += packer.pack(piece);
        text += piece;
        ASSERT_EQ(read(bytes), text) << "before its end";
    }
    EXPECT_LT(bytes.size(), text.size() / 2);
    bytes += packer.end();
    EXPECT_EQ(read(bytes), text);
    EXPECT_EQ(read(bytes, "plain"), bytes);
}

TEST_F(ZstdText, SmallPiecesReferToEarlierOnes) {
    ZstdPacker one, many;
    const std::string whole = one.pack(lines(0, 20000));
    std::string pieces;
    for (int i = 0; i < 1000; ++i) pieces += many.pack(lines(20 * i, 20));
    EXPECT_LT(static_cast<double>(pieces.size()), 1.6 * static_cast<double>(whole.size()));
}

TEST_F(ZstdText, EndsWithTheLastWholeBlock) {
    ZstdPacker packer;
    const std::string first = packer.pack(lines(0, 100)), second = packer.pack(lines(100, 100));
    for (std::size_t size = first.size(); size < first.size() + second.size(); ++size)
        ASSERT_EQ(read((first + second).substr(0, size)), lines(0, 100)) << size;
    EXPECT_EQ(read(""), "");
    EXPECT_EQ(read(first.substr(0, 3)), "");
}

TEST_F(ZstdText, ReadsSeveralFrames) {
    std::string bytes;
    for (const char* text : {"one\n", "two\n"}) {
        ZstdPacker packer;
        bytes += packer.pack(text);
        bytes += packer.end();
    }
    EXPECT_EQ(read(bytes), "one\ntwo\n");
}

TEST_F(ZstdText, RefusesBlankLinesWithoutEnd) {
    constexpr std::size_t kBlock = 8'000'000;
    std::string bytes;
    ZstdPacker packer;
    for (int i = 0; i < 8; ++i) bytes += packer.pack(std::string(kBlock, '\n'));
    EXPECT_EQ(read(bytes).size(), 8 * kBlock);
    for (int i = 0; i < 8; ++i) bytes += packer.pack(std::string(kBlock, '\n'));
    EXPECT_THROW((void)read(bytes), FormatError);
}

TEST_F(ZstdText, RefusesOtherBytes) {
    EXPECT_THROW((void)read("t,id,x,y\n"), FormatError);
    ZstdPacker packer;
    std::string bytes = packer.pack(lines(0, 1000));
    bytes += packer.end();
    bytes[bytes.size() - 1] = static_cast<char>(bytes[bytes.size() - 1] ^ 1);
    EXPECT_THROW((void)read(bytes), FormatError) << "the checksum";
}

}  // namespace zstd_text_test
}  // namespace ispace
