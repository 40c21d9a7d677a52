// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/picture.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"

namespace ispace {
namespace pgm_test {

using namespace std::string_literals;

std::string errorOf(const std::string& bytes) {
    try {
        parsePgm(bytes, "map.pgm");
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Pgm, ReadsBinary) {
    const GreyPicture image =
        parsePgm("P5\n# by hand\n3 2 # of these\n255\n\x00\x01\x02\n\xfe\xff"s, "x");
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.max_value, 255);
    // The newline among the samples is a sample.
    EXPECT_EQ(image.samples, (std::vector<std::uint16_t>{0, 1, 2, 10, 254, 255}));
}

TEST(Pgm, ReadsSixteenBitsBigEndian) {
    const GreyPicture image = parsePgm("P5 2 1 65535\n\x01\x02\xff\xff"s, "x");
    EXPECT_EQ(image.samples, (std::vector<std::uint16_t>{0x0102, 0xffff}));
    EXPECT_EQ(image.max_value, 65535);
}

TEST(Pgm, ReadsText) {
    const GreyPicture image = parsePgm("P2\n2 2\n1000\n0 7\n# rows\n1000\t999", "x");
    EXPECT_EQ(image.samples, (std::vector<std::uint16_t>{0, 7, 1000, 999}));
    EXPECT_EQ(image.max_value, 1000);
}

TEST(Pgm, NamesWhatIsWrong) {
    EXPECT_EQ(errorOf("P6\n1 1\n255\nabc"),
              "map.pgm: error: wrong magic `P6`, wanted a PGM picture (P2 or P5)");
    EXPECT_EQ(errorOf("P5\n384 384\n255\n" + std::string(100, 'x')),
              "map.pgm: error: truncated: 100 of 147456 bytes");
    EXPECT_EQ(errorOf("P5\n2 1\n256\nabc"), "map.pgm: error: truncated: 3 of 4 bytes");
    EXPECT_EQ(errorOf("P5\n2 1\n255\nabc"), "map.pgm: error: too long: 3 of 2 bytes");
    EXPECT_EQ(errorOf("P2\n2 2\n255\n1 2 3"), "map.pgm: error: truncated: 3 of 4 samples");
    EXPECT_EQ(errorOf("P2\n1 1\n255\n1 2"),
              "map.pgm: error: more than 1 samples: `2` behind the last one");
    EXPECT_EQ(errorOf("P2\n1 1\n255\n256"), "map.pgm: error: sample 256 is above the maximum 255");
    EXPECT_EQ(errorOf("P2\n1 1\n255\n-1"),
              "map.pgm: error: bad sample `-1`, wanted a number from 0 to 255");
    EXPECT_EQ(errorOf("P5\n3 x\n255\nabc"),
              "map.pgm: error: bad header: height `x`, wanted a number from 1 to 400000000");
    EXPECT_EQ(errorOf("P5\n3"), "map.pgm: error: truncated: the header ends before the height");
    EXPECT_EQ(errorOf("P5\n1 1\n255"), "map.pgm: error: truncated: 0 of 1 bytes");
    EXPECT_EQ(errorOf("P5\n1 1\n255#\na"),
              "map.pgm: error: bad header: wanted one blank between the maximum and the samples");
    EXPECT_EQ(errorOf(""), "map.pgm: error: empty file, wanted a PGM picture (P2 or P5)");
}

TEST(Pgm, RefusesAbsurdSizesBeforeItAllocates) {
    EXPECT_EQ(errorOf("P5\n1000000 1000000\n255\n"),
              "map.pgm: error: 1000000 x 1000000 pixels, wanted at most 400000000");
    EXPECT_NE(errorOf("P5\n99999999999999999999 1\n255\n").find("bad header: width"),
              std::string::npos);
    EXPECT_NE(errorOf("P5\n0 1\n255\n").find("bad header: width `0`"), std::string::npos);
    EXPECT_NE(errorOf("P5\n1 1\n65536\n").find("bad header: maximum"), std::string::npos);
    EXPECT_NE(errorOf("P5\n1 1\n0\n").find("bad header: maximum"), std::string::npos);
    EXPECT_EQ(errorOf("P2\n20000 20000\n255\n"),
              "map.pgm: error: truncated: 0 of 400000000 samples");
    EXPECT_EQ(errorOf("P5\n20000 20000\n255\n"), "map.pgm: error: truncated: 0 of 400000000 bytes");
}

TEST(Pgm, SurvivesEveryTruncationAndRandomBytes) {
    for (const std::string& whole :
         {"P5\n# c\n3 2\n255\nabcdef"s, "P2 # c\n3 2\n255\n1 2 3 4 5 6"s}) {
        for (std::size_t size = 0; size < whole.size(); ++size)
            EXPECT_THROW(parsePgm(whole.substr(0, size), "x"), FormatError) << size;
        EXPECT_NO_THROW(parsePgm(whole, "x"));
    }
    std::mt19937_64 random(4711);
    for (int i = 0; i < 20000; ++i) {
        std::string bytes = i % 2 == 0 ? "P5\n3 2\n255\nabcdef" : "P2\n3 2\n255\n1 2 3 4 5 6";
        for (int flips = 0; flips < 3; ++flips)
            bytes[2 + random() % (bytes.size() - 2)] = static_cast<char>(random());
        try {
            const GreyPicture image = parsePgm(bytes, "x");
            EXPECT_EQ(image.samples.size(), static_cast<std::size_t>(image.width * image.height));
        } catch (const FormatError&) {
            // Most of the files are damaged and rejected.
        }
    }
}

}  // namespace pgm_test
}  // namespace ispace
