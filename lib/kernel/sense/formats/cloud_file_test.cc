// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "sense/formats/point_cloud.h"

namespace ispace {
namespace cloud_file_test {

constexpr Encoding kEncodings[] = {Encoding::Binary, Encoding::Ascii};

PointCloud randomCloud(std::mt19937& random, std::size_t width, std::size_t height) {
    PointCloud cloud;
    cloud.width = width;
    cloud.height = height;
    std::uniform_real_distribution<float> place(-9, 9);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const bool is_missing = random() % 4 == 0;
        for (int part = 0; part < 3; ++part)
            cloud.xyz.push_back(is_missing ? std::numeric_limits<float>::quiet_NaN()
                                           : place(random));
    }
    return cloud;
}

std::string streamed(CloudFormat format, Encoding encoding, std::size_t width,
                     std::optional<std::size_t> rows, const std::vector<PointCloud>& clouds) {
    std::string bytes;
    CloudStream stream(format, encoding, width, rows,
                       [&bytes](std::string_view piece) { bytes += piece; });
    for (const PointCloud& cloud : clouds) stream.add(cloud);
    stream.finish();
    return bytes;
}

std::string whole(CloudFormat format, Encoding encoding, const PointCloud& cloud) {
    return format == CloudFormat::Pcd ? pcdOf(cloud, encoding) : plyOf(cloud, encoding);
}

TEST(CloudStream, EqualRowsStayRows) {
    std::mt19937 random(1);
    for (const std::size_t count : {1U, 2U, 40U})
        for (const std::size_t height : {1U, 3U}) {
            std::vector<PointCloud> clouds;
            PointCloud all;
            all.width = 50;
            all.height = count * height;
            for (std::size_t i = 0; i < count; ++i) {
                clouds.push_back(randomCloud(random, all.width, height));
                const std::vector<float>& xyz = clouds.back().xyz;
                all.xyz.insert(all.xyz.end(), xyz.begin(), xyz.end());
            }
            for (const CloudFormat format : {CloudFormat::Pcd, CloudFormat::Ply})
                for (const Encoding encoding : kEncodings) {
                    const std::string expected = whole(format, encoding, all);
                    EXPECT_EQ(streamed(format, encoding, 50, std::nullopt, clouds), expected);
                    EXPECT_EQ(streamed(format, encoding, 50, all.height, clouds), expected);
                }
        }
}

TEST(CloudStream, OfOtherRowsTheReturnsAreOneRow) {
    std::mt19937 random(2);
    const std::vector<PointCloud> clouds = {randomCloud(random, 7, 2), randomCloud(random, 5, 3)};
    PointCloud returns;
    for (const PointCloud& cloud : clouds)
        for (const float part : cloud.xyz)
            if (!std::isnan(part)) returns.xyz.push_back(part);
    returns.width = returns.xyz.size() / 3;
    for (const CloudFormat format : {CloudFormat::Pcd, CloudFormat::Ply})
        for (const Encoding encoding : kEncodings)
            EXPECT_EQ(streamed(format, encoding, 0, 5, clouds), whole(format, encoding, returns));
}

TEST(CloudRows, HaveNoWidthOnceOneDiffers) {
    CloudRows rows;
    rows.add(5, 2);
    rows.add(5, 1);
    EXPECT_EQ(rows.width, 5U);
    rows.add(4, 1);
    rows.add(5, 3);
    EXPECT_EQ(rows.width, 0U);
    EXPECT_EQ(rows.count, 7U);
    EXPECT_EQ(rows.points, 34U);
}

TEST(CloudStream, NoClouds) {
    for (const CloudFormat format : {CloudFormat::Pcd, CloudFormat::Ply})
        for (const std::size_t width : {0U, 9U})
            EXPECT_EQ(streamed(format, Encoding::Ascii, width, std::nullopt, {}),
                      whole(format, Encoding::Ascii, {}));
}

TEST(CloudStream, PcdOfKnownSizeIsWrittenAsItComes) {
    std::mt19937 random(3);
    std::size_t written = 0;
    CloudStream stream(CloudFormat::Pcd, Encoding::Binary, 100, 20,
                       [&written](std::string_view piece) { written += piece.size(); });
    const std::size_t header = written;
    EXPECT_GT(header, 100U);
    constexpr std::size_t kRows = 20, kRowBytes = sizeof(float) * 3 * 100;
    for (std::size_t row = 1; row <= kRows; ++row) {
        stream.add(randomCloud(random, 100, 1));
        EXPECT_EQ(written, header + row * kRowBytes);
    }
    stream.finish();
    EXPECT_EQ(written, header + kRows * kRowBytes);
}

}  // namespace cloud_file_test
}  // namespace ispace
