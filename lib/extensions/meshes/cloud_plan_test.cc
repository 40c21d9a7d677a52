// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/number.h"
#include "extensions/meshes/cloud_file.h"
#include "extensions/meshes/meshes.h"
#include "support/test_import.h"

namespace ispace::meshes {
namespace cloud_plan_test {

using Points = std::vector<std::array<double, 3>>;

std::string errorOf(const std::string& bytes, const ImportOptions& options = {}) {
    try {
        (void)readPointCloud(bytes, "cloud", options, sceneSchemas());
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

ImportOptions between(double low, double high) {
    ImportOptions options;
    options.slice_walls = low;
    options.slice_top = high;
    return options;
}

template <typename T>
void append(std::string& bytes, T value, bool reversed = false) {
    std::array<char, sizeof value> own{};
    std::memcpy(own.data(), &value, sizeof value);
    if (reversed) std::reverse(own.begin(), own.end());
    bytes.append(own.data(), own.size());
}

std::string pcd(const Points& points, const std::string& data) {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS i x y z\nSIZE 2 4 8 4\nTYPE U F F F\nCOUNT 1 1 1 1\n"
           "WIDTH " +
           std::to_string(points.size()) + "\nHEIGHT 1\nPOINTS " + std::to_string(points.size()) +
           "\nDATA " + data + '\n';
}

std::string asciiPcd(const Points& points) {
    std::string bytes = pcd(points, "ascii");
    for (const auto& [x, y, z] : points)
        bytes += "7 " + formatDouble(x) + ' ' + formatDouble(y) + ' ' + formatDouble(z) + '\n';
    return bytes;
}

std::string binaryPcd(const Points& points) {
    std::string bytes = pcd(points, "binary");
    for (const auto& [x, y, z] : points) {
        append(bytes, std::uint16_t{7});
        append(bytes, static_cast<float>(x));
        append(bytes, y);
        append(bytes, static_cast<float>(z));
    }
    return bytes;
}

/// Columns of fields, packed as literals alone; and the first column as one reference.
std::string packedPcd(const Points& points) {
    std::string columns(2 * points.size(), '\7');
    for (const auto& p : points) append(columns, static_cast<float>(p[0]));
    for (const auto& p : points) append(columns, p[1]);
    for (const auto& p : points) append(columns, static_cast<float>(p[2]));
    std::string packed{'\0', '\7'};
    std::size_t at = 1;
    while (2 * points.size() - at >= 9 && at < 200) {
        const std::size_t length = std::min<std::size_t>(2 * points.size() - at, 264);
        packed += static_cast<char>(7U << 5U);
        packed += static_cast<char>(length - 9);
        packed += '\0';
        at += length;
    }
    for (; at < columns.size(); at += 32) {
        const std::string piece = columns.substr(at, 32);
        packed += static_cast<char>(piece.size() - 1);
        packed += piece;
    }
    std::string bytes = pcd(points, "binary_compressed");
    append(bytes, static_cast<std::uint32_t>(packed.size()));
    append(bytes, static_cast<std::uint32_t>(columns.size()));
    return bytes + packed;
}

std::string ply(const Points& points, const std::string& format) {
    std::string bytes = "ply\nformat " + format + " 1.0\nelement vertex " +
                        std::to_string(points.size()) +
                        "\nproperty double x\nproperty uchar red\nproperty float y\nproperty "
                        "float z\nend_header\n";
    for (const auto& [x, y, z] : points) {
        if (format == "ascii") {
            bytes += formatDouble(x) + " 9 " + formatDouble(y) + ' ' + formatDouble(z) + '\n';
            continue;
        }
        const bool reversed = format == "binary_big_endian";
        append(bytes, x, reversed);
        bytes += '\t';
        append(bytes, static_cast<float>(y), reversed);
        append(bytes, static_cast<float>(z), reversed);
    }
    return bytes;
}

std::string las(const Points& points) {
    std::string bytes(227, '\0');
    const auto put = [&bytes](std::size_t at, auto value) {
        std::memcpy(&bytes[at], &value, sizeof value);
    };
    bytes.replace(0, 4, "LASF");
    bytes[24] = 1, bytes[25] = 2;
    put(94, std::uint16_t{227});
    put(96, std::uint32_t{227});
    put(105, std::uint16_t{20});
    put(107, static_cast<std::uint32_t>(points.size()));
    for (const std::size_t axis : {0U, 1U, 2U}) {
        put(131 + 8 * axis, 0.001);
        put(155 + 8 * axis, 10.0);
    }
    for (const auto& p : points) {
        for (const double v : p)
            append(bytes, static_cast<std::int32_t>(std::lround((v - 10) * 1000)));
        bytes.append(8, '\0');
    }
    return bytes;
}

/// A room of 6 m x 4 m, 2.5 m high, seen from within: floor, walls with a doorway 0.9 m wide, a
/// table of 1.2 m x 0.8 m whose top alone is seen, and a pillar.
Points room() {
    Points points;
    const double step = 0.04;
    for (double z = 0; z <= 2.5; z += step) {
        for (double x = 0; x <= 6; x += step) {
            if (x < 2 || x > 2.9) points.push_back({x, 0, z});
            points.push_back({x, 4, z});
        }
        for (double y = 0; y <= 4; y += step) {
            points.push_back({0, y, z});
            points.push_back({6, y, z});
        }
        for (double a = 0; a < 1; a += 0.02) points.push_back({3 + a / 2, 3, z});
    }
    for (double x = 0; x <= 6; x += step)
        for (double y = 0; y <= 4; y += step) points.push_back({x, y, 0});
    for (double x = 1; x <= 2.2; x += step / 2)
        for (double y = 1; y <= 1.8; y += step / 2) points.push_back({x, y, 0.75});
    return points;
}

TEST(CloudFile, AllFormatsHoldTheSamePoints) {
    const Points points{{1, 2, 3}, {-4.5, 0.25, 1e3}, {0, 0, -1}, {1, 1, 1}, {2, 2, 2},
                        {3, 3, 3}, {4, 4, 4},         {5, 5, 5},  {6, 6, 6}, {7, 7, 7}};
    for (const std::string& bytes :
         {asciiPcd(points), binaryPcd(points), packedPcd(points), ply(points, "ascii"),
          ply(points, "binary_little_endian"), ply(points, "binary_big_endian"), las(points)}) {
        ASSERT_TRUE(isPointCloud(bytes));
        Points found;
        const std::string name = "cloud";
        CloudFile(bytes, name).forEach([&](const Point3& p) { found.push_back({p.x, p.y, p.z}); });
        EXPECT_EQ(found, points) << bytes.substr(0, 200);
    }
    EXPECT_FALSE(isPointCloud("ply\nformat ascii 1.0\nelement vertex 3\nelement face 1\n"));
    EXPECT_FALSE(isPointCloud(""));
}

TEST(CloudFile, PointsWithoutAPlaceAreLeftOut) {
    const std::string name = "cloud";
    std::size_t count = 0;
    CloudFile(pcd({{}, {}, {}}, "ascii") + "1 nan 0 0\n1 1 2 3\n1 0 NaN inf\n", name)
        .forEach([&count](const Point3&) { ++count; });
    EXPECT_EQ(count, 1U);
}

TEST(CloudPlan, ARoomComesBackWithItsThings) {
    const Document document =
        readPointCloud(asciiPcd(room()), "cloud", between(0.5, 1.8), sceneSchemas());
    const Environment found = environmentOf(document);
    EXPECT_NEAR(found.indoor().area(), 24, 0.02 * 24);
    EXPECT_NEAR(found.limits().width(), 6, 0.06);
    ASSERT_EQ(countOf(document, "cube"), 1U);
    for (const Record& record : document.records) {
        if (record.keyword() != "cube") continue;
        EXPECT_NEAR(record.tuple("at")[0], 1.6, 0.05);
        EXPECT_NEAR(record.tuple("at")[2], 0.75, 0.05);  // its legs were not seen
        EXPECT_NEAR(record.tuple("size")[0], 1.2, 0.1);
        EXPECT_NEAR(record.tuple("size")[1], 0.8, 0.1);
    }
    EXPECT_NE(warningsOf(document).find("the walls have gaps: those of up to 0.9 m are closed"),
              std::string::npos)
        << warningsOf(document);
}

TEST(CloudPlan, SurveyorsCoordinatesMoveToTheOrigin) {
    Points points = room();
    for (auto& [x, y, z] : points) x += 450'000, y += 1'400'000;
    ImportOptions options = between(0.5, 1.8);
    ImportReport report;
    options.report = &report;
    const Document document = readPointCloud(las(points), "cloud", options, sceneSchemas());
    EXPECT_NEAR(environmentOf(document).indoor().area(), 24, 0.02 * 24);
    EXPECT_EQ(countOf(document, "cube"), 1U);
    ASSERT_EQ(report.choices.size(), 1U);
    EXPECT_NE(report.choices[0].message.find(" m: the cloud stands in surveyors' coordinates"),
              std::string::npos)
        << report.choices[0].message;
}

TEST(CloudPlan, UnitsAndUpwardAxisAreThoseOfTheOptions) {
    Points lying = room();  // millimetres, y up, as cameras have it
    for (auto& [x, y, z] : lying) {
        const double height = z;
        x *= 1000;
        z = -1000 * y;
        y = 1000 * height;
    }
    ImportOptions options = between(0.5, 1.8);
    EXPECT_NE(errorOf(asciiPcd(lying), options).find("are --units and --up right?"),
              std::string::npos);
    options.units = "mm";
    options.own.edit<UpAxis>().name = "y";
    const auto records = [](const Points& points, const ImportOptions& how) {
        return writeRecordText(readPointCloud(asciiPcd(points), "cloud", how, sceneSchemas()));
    };
    EXPECT_EQ(records(lying, options), records(room(), between(0.5, 1.8)));
    Points on_side = room();
    for (auto& p : on_side) p = {p[2], p[0], p[1]};
    ImportOptions sideways = between(0.5, 1.8);
    sideways.own.edit<UpAxis>().name = "x";
    EXPECT_EQ(records(on_side, sideways), records(room(), between(0.5, 1.8)));
}

TEST(CloudPlan, SaysHow) {
    const std::string bytes = asciiPcd(room());
    EXPECT_NE(errorOf(bytes).find("--slice-walls 0.5..1.8 --resolution 5cm; its points reach from "
                                  "0.00 m to 2.48 m in height"),
              std::string::npos)
        << errorOf(bytes);
    EXPECT_NE(errorOf(bytes, between(5, 6)).find("no point lies between the heights"),
              std::string::npos);
    EXPECT_NE(errorOf(asciiPcd({{0, 0, 1}, {5, 5, 1}}), between(0, 2)).find("enclose no room"),
              std::string::npos);
    EXPECT_NE(errorOf(asciiPcd({{0, 0, 1}, {9e5, 9e5, 1}}), between(0, 2))
                  .find("cells of 0.05 m make more than 25 million; take larger ones with "
                        "--resolution"),
              std::string::npos);
    // Two points do not explain 16 million cells.
    const std::string far = asciiPcd({{0, 0, 1}, {200, 200, 1}});
    EXPECT_NE(errorOf(far, between(0, 2)).find("units of work (`--max-work "), std::string::npos)
        << errorOf(far, between(0, 2));
    ImportOptions coarse = between(0, 2);
    coarse.resolution = 0.2;
    EXPECT_NE(errorOf(far, coarse).find("enclose no room"), std::string::npos);
}

TEST(CloudPlan, DamageIsAnError) {
    const Points points{{1, 2, 3}, {4, 5, 6}};
    std::string laz = las(points);
    laz[104] = static_cast<char>(0x80);
    EXPECT_NE(errorOf(laz).find("(LAZ): unpack it"), std::string::npos);
    EXPECT_NE(errorOf(las(points).substr(0, 250)).find("truncated"), std::string::npos);
    EXPECT_NE(errorOf(pcd(points, "ascii") + "1 2 x 4\n").find("found `x`, wanted a number"),
              std::string::npos);
    EXPECT_NE(errorOf(pcd(points, "ascii") + "1 2 3 4\n").find("truncated: 2 points"),
              std::string::npos);
    constexpr int kRounds = 300;
    for (const std::string& bytes : {asciiPcd(points), binaryPcd(points), packedPcd(points),
                                     ply(points, "binary_big_endian"), las(points)})
        surviveDamage(
            bytes,
            [](const std::string& damaged) {
                (void)readPointCloud(damaged, "cloud", between(0, 10), sceneSchemas());
            },
            kRounds);
}

}  // namespace cloud_plan_test
}  // namespace ispace::meshes
