// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/picture.h"

#include <gtest/gtest.h>

#include <random>

#include "base/confined.h"
#include "base/error.h"
#include "raster/codec.h"
#include "support/test_png.h"

namespace ispace {
namespace png_test {

using namespace std::string_literals;
using Samples = std::vector<std::uint16_t>;
using Opacity = std::vector<std::uint8_t>;

std::string errorOf(const std::string& bytes) {
    try {
        parsePicture(bytes, "map.png");
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

TEST(PngPicture, Grey) {
    const GreyPicture picture = parsePng(pngFile(3, 8, 0, {"\x00\x01\x02"s, "\xcd\xfe\xff"}), "x");
    EXPECT_EQ(picture.width, 3);
    EXPECT_EQ(picture.height, 2);
    EXPECT_EQ(picture.max_value, 765);
    EXPECT_EQ(picture.samples, (Samples{0, 3, 6, 3 * 205, 3 * 254, 765}));
    EXPECT_TRUE(picture.opacity.empty());
}

TEST(PngPicture, BitsPaletteAndColours) {
    EXPECT_EQ(parsePng(pngFile(9, 1, 0, {"\xaa\x80"}), "x").samples,
              (Samples{765, 0, 765, 0, 765, 0, 765, 0, 765}));
    EXPECT_EQ(parsePng(pngFile(2, 4, 0, {"\x0f"}), "x").samples, (Samples{0, 765}));
    EXPECT_EQ(parsePng(pngFile(2, 8, 2, {"\x01\x02\x03\xff\x00\x0a"s}), "x").samples,
              (Samples{6, 265}));
    const std::string palette = pngChunk("PLTE", "\x0a\x0b\x0c\xff\xff\xff");
    EXPECT_EQ(parsePng(pngFile(2, 8, 3, {"\x01\x00"s}, palette), "x").samples, (Samples{765, 33}));
}

TEST(PngPicture, Opacity) {
    const GreyPicture grey = parsePng(pngFile(2, 8, 4, {"\x80\xff\x20\x40"}), "x");
    EXPECT_EQ(grey.samples, (Samples{384, 96}));
    EXPECT_EQ(grey.opacity, (Opacity{255, 64}));
    const GreyPicture color = parsePng(pngFile(1, 8, 6, {"\x01\x02\x03\x04"}), "x");
    EXPECT_EQ(color.samples, (Samples{6}));
    EXPECT_EQ(color.opacity, (Opacity{4}));
    // One entry of the palette is transparent.
    const std::string palette =
        pngChunk("PLTE", "\x0a\x0b\x0c\xff\xff\xff") + pngChunk("tRNS", "\x00"s);
    EXPECT_EQ(parsePng(pngFile(2, 8, 3, {"\x01\x00"s}, palette), "x").opacity, (Opacity{255, 0}));
}

TEST(PngPicture, SixteenBitsAreRoundedAndNotBent) {
    const GreyPicture picture =
        parsePng(pngFile(4, 16, 0, {"\x00\x00\x80\x80\xcd\xcd\xff\xff"s}), "x");
    EXPECT_EQ(picture.samples, (Samples{0, 3 * 128, 3 * 205, 765}));
}

TEST(PngPicture, ColourSpacesDoNotCount) {
    const Samples plain = parsePng(pngFile(2, 8, 0, {"\x40\xcd"}), "x").samples;
    // A gamma of 1, which would brighten the picture; an invalid profile.
    for (const std::string& chunk : {pngChunk("gAMA", bigEndian32(100000)),
                                     pngChunk("iCCP", "x\0\0nonsense"s), pngChunk("sRGB", "\x00"s)})
        EXPECT_EQ(parsePng(pngFile(2, 8, 0, {"\x40\xcd"}, chunk), "x").samples, plain);
}

TEST(PngPicture, NamesWhatIsWrong) {
    const std::string good = pngFile(2, 8, 0, {"ab", "cd"});
    EXPECT_EQ(errorOf(good), "no error");
    EXPECT_EQ(errorOf(good.substr(0, 20)), "map.png: error: truncated PNG picture");
    EXPECT_EQ(errorOf(good.substr(0, 8) + good.substr(33)),
              "map.png: error: bad PNG picture: it does not begin with its header");
    std::string damaged = good;
    damaged[45] = static_cast<char>(damaged[45] + 1);  // within the samples
    EXPECT_EQ(errorOf(damaged).find("map.png: error: bad PNG picture: "), 0U) << errorOf(damaged);
    EXPECT_EQ(errorOf(pngFile(2, 8, 0, {})).find("map.png: error: bad PNG picture: "), 0U);
    EXPECT_NE(errorOf("GIF89a").find("map.png: error: a GIF picture: convert it"),
              std::string::npos);
    EXPECT_NE(errorOf("nonsense").find("wrong magic"), std::string::npos);
}

TEST(PngPicture, RefusesAbsurdSizesBeforeItAllocates) {
    EXPECT_EQ(errorOf(pngFile(200'000'000, 8, 0, {"a"})),
              "map.png: error: 200000000 x 1 pixels, wanted at most 100000000");
    EXPECT_EQ(errorOf(pngFile(100'000'000, 16, 6, {"a"})),
              "map.png: error: truncated PNG picture: 13 bytes of data do not hold 100000000 x 1 "
              "pixels");
    EXPECT_NE(errorOf(pngFile(0xffffffff, 8, 0, {"a"})).find("wanted at most"), std::string::npos);
}

TEST(PngPicture, SurvivesEveryTruncationAndFlippedBits) {
    const std::string good = pngFile(3, 8, 6, {"abcdefghijkl", "mnopqrstuvwx"});
    for (std::size_t i = 8; i < good.size(); ++i)
        EXPECT_NE(errorOf(good.substr(0, i)), "no error") << i;
    std::mt19937_64 random(77);
    for (int i = 0; i < 3000; ++i) {
        std::string bytes = good;
        for (int k = 0; k < 3; ++k)
            bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
        errorOf(bytes);
    }
}

TEST(PngPicture, OpacityInMaps) {
    using Mode = OccupancyRule::Mode;
    // White and black, opaque and clear.
    const GreyPicture picture =
        parsePng(pngFile(4, 8, 4, {"\xff\xff\xff\x00\x00\xff\x00\x00"s}), "x");
    const auto free = [&](Mode mode, double free_thresh) {
        OccupancyRule rule;
        rule.mode = mode;
        rule.free_thresh = free_thresh;
        const MapCells cells = freeCells(picture, rule);
        std::string text;
        for (int x = 0; x < 4; ++x) text += cells.contains(x, 0) ? '.' : '#';
        return text;
    };
    // Averaged with the three colours: 0, 1/4, 3/4 and 1 dark.
    EXPECT_EQ(free(Mode::Trinary, 0.2), ".###");
    EXPECT_EQ(free(Mode::Trinary, 0.3), "..##");
    EXPECT_EQ(free(Mode::Scale, 0.3), ".###");
    // Raw: 0 is free whatever its opacity.
    EXPECT_EQ(free(Mode::Raw, 0.2), "##..");
}

TEST(ColorPicture, HasTheColoursOfTheFile) {
    const std::string png = pngFile(2, 8, 6, {std::string("\x10\x20\x30\xff\x01\x02\x03\x00", 8)});
    ConfinedReader reader;
    EXPECT_EQ(parseColorPicture(png, "a.png", reader).rgba,
              (std::vector<std::uint8_t>{0x10, 0x20, 0x30, 0xff, 1, 2, 3, 0}));
    EXPECT_EQ(parseColorPicture("P2\n1 2\n10\n10 0\n", "a.pgm", reader).rgba,
              (std::vector<std::uint8_t>{255, 255, 255, 255, 0, 0, 0, 255}));
    // Through OpenCV, which has blue first.
    const ColorPicture ppm = parseColorPicture("P6\n1 1\n255\n\x01\x02\x03", "a.ppm", reader);
    EXPECT_EQ(ppm.rgba, (std::vector<std::uint8_t>{1, 2, 3, 255}));
    EXPECT_THROW(parseColorPicture("no picture", "a.png", reader), FormatError);
}

TEST(ColorPicture, OneProgramDecodesManyUntilOneIsDamaged) {
    ConfinedReader reader;
    const auto red = [&](const std::string& head) {
        const std::string bytes = head + std::string("\x09\x02\x03\x09\x02\x03", 6);
        return parseColorPicture(bytes, "a.ppm", reader).rgba;
    };
    const std::vector<std::uint8_t> pixels{9, 2, 3, 255, 9, 2, 3, 255};
    EXPECT_EQ(reader.starts(), 0);
    for (int i = 0; i < 20; ++i)
        EXPECT_EQ(red(i % 2 == 0 ? "P6\n2 1\n255\n" : "P6 1 2 255 "), pixels);
    EXPECT_EQ(reader.starts(), 1);
    try {
        parseColorPicture(
            "BM" + std::string(12, '\0') + std::string("\x28\0\0\0\x01\0\0\0\x01\0\0\0", 12),
            "cut.bmp", reader);
        ADD_FAILURE() << "decoded";
    } catch (const FormatError& error) {
        EXPECT_STREQ(error.what(), "cut.bmp: error: bad BMP picture: OpenCV cannot decode it");
    }
    EXPECT_EQ(red("P6\n2 1\n255\n"), pixels);
    EXPECT_EQ(reader.starts(), 2);
}

/// Red, green and blue of each pixel of a PNG.
std::vector<std::uint32_t> pixelsOf(const std::string& png) {
    ConfinedReader reader;
    const std::vector<std::uint8_t> rgba = parseColorPicture(png, "a.png", reader).rgba;
    std::vector<std::uint32_t> pixels;
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        pixels.push_back(std::uint32_t{rgba[i]} << 16U | std::uint32_t{rgba[i + 1]} << 8U |
                         rgba[i + 2]);
    return pixels;
}

TEST(EncodedPng, HasThePixels) {
    std::mt19937 random(3);
    for (const int columns : {1, 3, 200})
        for (const int rows : {1, 2, 150})
            for (const bool noisy : {false, true}) {
                constexpr std::size_t kBehind = 5;  // pixels of each row that are not the picture's
                const std::size_t stride = static_cast<std::size_t>(columns) + kBehind;
                std::vector<std::uint32_t> memory, pixels;
                for (int row = 0; row < rows; ++row)
                    for (std::size_t column = 0; column < stride; ++column) {
                        const bool is_dark = column / 20 % 2 == 0;
                        const std::uint32_t pixel = noisy     ? static_cast<std::uint32_t>(random())
                                                    : is_dark ? 0xff102030U
                                                              : 0x00fffefdU;
                        memory.push_back(pixel);
                        if (column + kBehind < stride) pixels.push_back(pixel & 0xffffffU);
                    }
                memory.resize(memory.size() - kBehind);
                EXPECT_EQ(pixelsOf(pngOfDrawing(columns, rows, memory, stride)), pixels);
                EXPECT_EQ(pixelsOf(pngOfShades(columns, rows, pixels)), pixels);
                std::vector<std::uint8_t> samples;
                for (const std::uint32_t pixel : pixels)
                    for (const unsigned shift : {16U, 8U, 0U})
                        samples.push_back(static_cast<std::uint8_t>(pixel >> shift));
                EXPECT_EQ(pixelsOf(pngOfRgb(columns, rows, samples)), pixels);
            }
}

TEST(EncodedPng, HasThePixelsOfLargeDrawings) {
    // More than is packed at once.
    constexpr int kColumns = 5000, kRows = 4400;
    std::vector<std::uint32_t> pixels(std::size_t{kColumns} * kRows, 0xE0E4E8);
    for (std::size_t i = 0; i < pixels.size(); i += 997) pixels[i] = 0x102030;
    EXPECT_EQ(pixelsOf(pngOfDrawing(kColumns, kRows, pixels, kColumns)), pixels);
}

}  // namespace png_test
}  // namespace ispace
