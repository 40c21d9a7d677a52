// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

#include "base/file.h"
#include "raster/picture.h"
#include "support/test_cells.h"
#include "support/test_damage.h"
#include "support/test_paths.h"

namespace ispace {

namespace picture_test {

std::string fileOf(const std::string& suffix) {
    return readAll(testing::sourcePath("tests/data/pictures/room.") + suffix);
}

std::string errorOf(const std::string& bytes) {
    return errorsOf([&] { decodePicture(bytes, "plan.x"); });
}

/// A header of BMP, 24 bits a pixel, without pixels.
std::string bmpHeader(std::int64_t width, std::int64_t height) {
    std::string bytes = "BM";
    const auto add = [&bytes](std::int64_t value, int count) {
        for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
    };
    for (const std::int64_t value :
         {std::int64_t{54}, std::int64_t{0}, std::int64_t{54}, std::int64_t{40}, width, height})
        add(value, 4);
    add(1, 2);
    add(24, 2);
    for (int i = 0; i < 6; ++i) add(0, 4);
    return bytes;
}

TEST(PictureModule, KnowsFormats) {
    EXPECT_EQ(foreignPicture(fileOf("jpg")), "JPEG");
    EXPECT_EQ(foreignPicture(fileOf("bmp")), "BMP");
    EXPECT_EQ(foreignPicture(fileOf("tif")), "TIFF");
    EXPECT_EQ(foreignPicture(fileOf("webp")), "WebP");
    EXPECT_EQ(foreignPicture(fileOf("pbm")), "PNM");
    EXPECT_EQ(foreignPicture(fileOf("pgm")), "");
    EXPECT_EQ(foreignPicture(fileOf("png")), "");
    for (const char* text : {"", "BM", "BMI: 3", "MM", "II*", "P3", "P30", "RIFF", "MMXX: 1"})
        EXPECT_EQ(foreignPicture(text), "") << text;
}

TEST(PictureModule, SameRoomInAllFormats) {
    const GreyPicture wanted = parsePicture(fileOf("pgm"), "room.pgm");
    for (const char* suffix : {"jpg", "bmp", "tif", "webp"}) {
        const GreyPicture found = decodePicture(fileOf(suffix), suffix);
        ASSERT_EQ(found.width, 160) << suffix;
        ASSERT_EQ(found.height, 120) << suffix;
        EXPECT_EQ(found.max_value, 765) << suffix;
        EXPECT_TRUE(found.opacity.empty()) << suffix;
        ASSERT_EQ(found.samples.size(), wanted.samples.size()) << suffix;
        for (std::size_t i = 0; i < wanted.samples.size(); ++i)
            ASSERT_NEAR(found.samples[i], 3 * wanted.samples[i], 3 * 24) << suffix << ' ' << i;
    }
}

TEST(PictureModule, TextOfPixels) {
    const GreyPicture picture = decodePicture("P3\n# by hand\n2 1 255\n255 0 0  1 2 3\n", "p.ppm");
    EXPECT_EQ(picture.samples, (std::vector<std::uint16_t>{255, 6}));
}

TEST(PictureModule, RefusesSizes) {
    EXPECT_EQ(errorOf(bmpHeader(60000, 60000)),
              "plan.x: error: 60000 x 60000 pixels, wanted at most 100000000\n");
    EXPECT_EQ(errorOf(bmpHeader(60000, -60000)),
              "plan.x: error: 60000 x 60000 pixels, wanted at most 100000000\n");
    EXPECT_NE(errorOf(bmpHeader(0, 3)).find("its header says no size"), std::string::npos);
    EXPECT_NE(errorOf("P6 70000 70000 255\n").find("wanted at most"), std::string::npos);
    EXPECT_NE(errorOf("P6 70000").find("says no size"), std::string::npos);
    std::string jpeg = fileOf("jpg");
    const std::size_t frame = jpeg.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    for (std::size_t i = 5; i < 9; ++i) jpeg[frame + i] = '\xff';
    EXPECT_EQ(errorOf(jpeg), "plan.x: error: 65535 x 65535 pixels, wanted at most 100000000\n");
    std::string webp("RIFF\x20\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0", 24);
    webp += std::string(6, '\xff');
    EXPECT_NE(errorOf(webp).find("16777216 x 16777216 pixels"), std::string::npos);
}

TEST(PictureModule, RefusesWhatIsCutOff) {
    for (const char* suffix : {"jpg", "bmp", "webp"}) {
        const std::string whole = fileOf(suffix);
        for (const std::size_t size : {whole.size() / 4, whole.size() / 2, whole.size() - 2})
            EXPECT_EQ(errorOf(whole.substr(0, size)).substr(0, 15), "plan.x: error: ")
                << suffix << ' ' << size;
    }
}

TEST(PictureModule, SurvivesDamageInSilence) {
    ::testing::internal::CaptureStderr();
    std::mt19937_64 random(3);
    for (const char* suffix : {"jpg", "tif", "webp"}) {
        const std::string good = fileOf(suffix);
        // Few: each starts a program.
        for (int round = 0; round < 12; ++round) {
            std::string bytes =
                good.substr(0, round % 2 == 0 ? random() % good.size() : good.size());
            for (auto n = random() % 4; n > 0 && !bytes.empty(); --n)
                bytes[random() % bytes.size()] = static_cast<char>(random());
            EXPECT_NE(errorsOf([&] {
                          if (!foreignPicture(bytes).empty()) decodePicture(bytes, "plan.x");
                      }),
                      "");
        }
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

using testing::cellsOf;
using testing::rowsOf;

TEST(Occupancy, TrinaryComparesStrictly) {
    OccupancyRule rule;  // 0.65 and 0.196
    EXPECT_EQ(classify(254, 255, rule), Cell::Free);
    EXPECT_EQ(classify(206, 255, rule), Cell::Free);     // 0.1922
    EXPECT_EQ(classify(205, 255, rule), Cell::Unknown);  // 0.19608: map_server's unknown
    EXPECT_EQ(classify(0, 255, rule), Cell::Occupied);
    rule.free_thresh = 0.2;
    rule.occupied_thresh = 0.8;
    EXPECT_EQ(classify(204, 255, rule), Cell::Unknown);  // exactly 0.2
    EXPECT_EQ(classify(205, 255, rule), Cell::Free);
    EXPECT_EQ(classify(51, 255, rule), Cell::Unknown);  // exactly 0.8
    EXPECT_EQ(classify(50, 255, rule), Cell::Occupied);
    rule.mode = OccupancyRule::Mode::Scale;
    EXPECT_EQ(classify(205, 255, rule), Cell::Free);
    EXPECT_EQ(classify(128, 255, rule), Cell::Unknown);
}

TEST(Occupancy, ScaleCountsHundredthsBetweenTheThresholds) {
    OccupancyRule rule;
    rule.mode = OccupancyRule::Mode::Scale;
    rule.free_thresh = 0;  // as masks for Nav2's filters have it
    rule.occupied_thresh = 1;
    EXPECT_EQ(classify(255, 255, rule), Cell::Free);
    EXPECT_EQ(classify(254, 255, rule), Cell::Free);     // 0.39 of 100
    EXPECT_EQ(classify(253, 255, rule), Cell::Unknown);  // 0.78
    EXPECT_EQ(classify(0, 255, rule), Cell::Occupied);
    EXPECT_EQ(classify(2, 255, rule), Cell::Unknown);  // 99.2
}

TEST(Occupancy, NegateTurnsShadesAround) {
    OccupancyRule rule;
    rule.negate = true;
    EXPECT_EQ(classify(0, 255, rule), Cell::Free);
    EXPECT_EQ(classify(255, 255, rule), Cell::Occupied);
    EXPECT_EQ(classify(50, 255, rule), Cell::Unknown);
}

TEST(Occupancy, SixteenBitsMeanTheSame) {
    EXPECT_EQ(classify(65535, 65535, {}), Cell::Free);
    EXPECT_EQ(classify(205 * 257, 65535, {}), Cell::Unknown);
    EXPECT_EQ(classify(100, 65535, {}), Cell::Occupied);
}

TEST(Occupancy, RawTakesThePixelAsValue) {
    OccupancyRule rule;
    rule.mode = OccupancyRule::Mode::Raw;
    rule.negate = true;  // ignored, as the thresholds are
    EXPECT_EQ(classify(0, 255, rule), Cell::Free);
    EXPECT_EQ(classify(100, 255, rule), Cell::Occupied);
    EXPECT_EQ(classify(99, 255, rule), Cell::Unknown);
    EXPECT_EQ(classify(255, 255, rule), Cell::Unknown);
    EXPECT_EQ(classify(100 * 257, 65535, rule), Cell::Occupied);
}

TEST(Occupancy, TopRowOfThePictureIsTheHighest) {
    GreyPicture image;
    image.width = 2;
    image.height = 2;
    image.samples = {254, 0, 205, 254};
    EXPECT_EQ(rowsOf(freeCells(image, {})), (std::vector<std::string>{".#", "#."}));
    EXPECT_TRUE(freeCells(image, {}).contains(0, 1));
}

}  // namespace picture_test

}  // namespace ispace
