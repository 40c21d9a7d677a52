// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/camera_info.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdint>

#include "support/test_readings.h"

namespace ispace {
namespace depth_png_test {

/// Samples of a 16-bit grey PNG.
std::vector<std::uint16_t> samplesOf(const std::string& bytes) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
    EXPECT_EQ(image.format, PNG_FORMAT_LINEAR_Y);
    image.format = PNG_FORMAT_LINEAR_Y;
    std::vector<std::uint16_t> samples(static_cast<std::size_t>(image.width) * image.height);
    EXPECT_NE(png_image_finish_read(&image, nullptr, samples.data(), 0, nullptr), 0);
    png_image_free(&image);
    return samples;
}

std::string chunkNames(std::string_view png) {
    std::string names;
    for (std::size_t at = 8; at + 12 <= png.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i)
            length = length * 256 + static_cast<unsigned char>(png[at + i]);
        names.append(png.substr(at + 4, 4)).append(" ");
        at += length + 12;
    }
    return names;
}

TEST(DepthPng, MillimetresAndZeroForNoReturn) {
    DepthFrame frame;
    frame.depths = {1.2344F, 1.2346F, kNone, 0.0004F, 65.535F, 65.536F, 100, 3};
    EXPECT_EQ(samplesOf(depthPng(4, 2, frame.depths, 1000)),
              (std::vector<std::uint16_t>{1234, 1235, 0, 0, 65535, 0, 0, 3000}));
    EXPECT_EQ(samplesOf(depthPng(4, 2, frame.depths, 5000)),
              (std::vector<std::uint16_t>{6172, 6173, 0, 2, 0, 0, 0, 15000}));
}

TEST(DepthPng, HoldsNothingButThePicture) {
    std::mt19937 random(4);
    DepthFrame frame;
    frame.depths = randomRanges(random, std::size_t{176} * 144);
    const std::string png = depthPng(176, 144, frame.depths, 1000);
    std::string names = chunkNames(png);
    EXPECT_TRUE(names.starts_with("IHDR IDAT ")) << names;
    EXPECT_TRUE(names.ends_with("IDAT IEND ")) << names;
    EXPECT_EQ(names.find_first_not_of("IDATEHNR "), std::string::npos) << names;
    EXPECT_EQ(png, depthPng(176, 144, frame.depths, 1000));
    const std::vector<std::uint16_t> samples = samplesOf(png);
    ASSERT_EQ(samples.size(), frame.depths.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double millimetres = double{frame.depths[i]} * 1000;
        ASSERT_EQ(samples[i], std::isinf(millimetres) ? 0 : std::lround(millimetres)) << i;
    }
}

TEST(CameraInfo, Yaml) {
    Ranger ranger;
    ranger.columns = 640;
    ranger.rows = 480;
    ranger.fov_x = Angle::degrees(90);
    ranger.fov_y = Angle::degrees(90);
    EXPECT_EQ(cameraInfoYaml(cameraInfoOf(ranger), "r\"1"),
              "%YAML 1.0\n---\n"
              "# Pixel centres are whole numbers: the middle of the picture is (columns - 1) / 2.\n"
              "image_width: 640\nimage_height: 480\ncamera_name: \"r\\\"1\"\n"
              "camera_matrix:\n  rows: 3\n  cols: 3\n"
              "  data: [320.0, 0.0, 319.5, 0.0, 240.0, 239.5, 0.0, 0.0, 1.0]\n"
              "distortion_model: plumb_bob\n"
              "distortion_coefficients:\n  rows: 1\n  cols: 5\n"
              "  data: [0.0, 0.0, 0.0, 0.0, 0.0]\n"
              "rectification_matrix:\n  rows: 3\n  cols: 3\n"
              "  data: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\n"
              "projection_matrix:\n  rows: 3\n  cols: 4\n"
              "  data: [320.0, 0.0, 319.5, 0.0, 0.0, 240.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0]\n");
}

}  // namespace depth_png_test
}  // namespace ispace
